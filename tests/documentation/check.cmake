# cmake -D SOURCE=REPOSITORY -P check.cmake: fails unless
# - each C++ block of README.md and of docs/ names a file of the repository on the line before it, as in
#   `<!-- examples/learn/own_metric.cpp -->`, and its lines stand in that file, in a row. The tests build these files;
# - each relative link of these pages leads to a file;
# - the lines of the pages of docs/learn/ and docs/reference/ have at most 120 characters, tables apart.
cmake_minimum_required(VERSION 3.25)

set(violations 0)
function(violation text)
  message("${text}")
  math(EXPR violations "${violations} + 1")
  set(violations ${violations} PARENT_SCOPE)
endfunction()

# Pages that were not moved to one of the three shelves yet: their blocks name no program.
set(without_programs docs/directions.md docs/models.md docs/robust-estimation.md)

# line_of(RESULT TEXT POSITION): the number of the line that a position is in.
function(line_of result text position)
  string(SUBSTRING "${text}" 0 ${position} before)
  string(REGEX MATCHALL "\n" newlines "${before}")
  list(LENGTH newlines line)
  set(${result} ${line} PARENT_SCOPE) # the text has a line feed put before its first line
endfunction()

# The C++ blocks of a page.
function(check_blocks page text)
  set(rest "${text}")
  set(consumed 0)
  while(TRUE)
    string(REGEX MATCH "\n```(cpp|c[+][+]|C[+][+]|cxx)[^\n]*\n" opening "${rest}")
    if(NOT opening)
      break()
    endif()
    string(FIND "${rest}" "${opening}" position)
    math(EXPR at "${consumed} + ${position} + 1")
    line_of(line "${text}" ${at})
    string(SUBSTRING "${rest}" 0 ${position} before)
    string(LENGTH "${opening}" length)
    math(EXPR position "${position} + ${length}")
    string(SUBSTRING "${rest}" ${position} -1 rest)
    math(EXPR consumed "${consumed} + ${position}")
    string(FIND "${rest}" "\n```" end)
    string(SUBSTRING "${rest}" 0 ${end} block)

    if(NOT before MATCHES "\n<!-- ([a-zA-Z0-9_./-]+) -->$")
      violation("${page}:${line}: the line before this C++ block must name its program: <!-- examples/learn/NAME.cpp -->")
      continue()
    endif()
    set(program "${CMAKE_MATCH_1}")
    if(NOT EXISTS "${SOURCE}/${program}")
      violation("${page}:${line}: there is no file ${program}")
      continue()
    endif()
    file(READ "${SOURCE}/${program}" code)
    string(FIND "\n${code}\n" "\n${block}\n" found)
    if(found EQUAL -1)
      violation("${page}:${line}: this block is not in ${program}, line by line")
    endif()
  endwhile()
  set(violations ${violations} PARENT_SCOPE)
endfunction()

# Links to files, as far as these are ours: [text](path) and [text](path#heading).
function(check_links page text)
  cmake_path(GET page PARENT_PATH folder)
  string(REGEX REPLACE "\n```[^`]*\n```" "" text "${text}") # what looks like a link in a block is none
  # A list's elements must not hold what lists are made of.
  string(REPLACE ";" "," text "${text}")
  string(REPLACE "](" "@@(" text "${text}")
  string(REGEX REPLACE "[][\\]" "" text "${text}")
  string(REGEX MATCHALL "@@\\([^)\n ]+\\)" links "${text}")
  foreach(link IN LISTS links)
    string(REGEX REPLACE "^.*\\(([^)#]*)(#[^)]*)?\\)$" "\\1" path "${link}")
    if(path STREQUAL "" OR path MATCHES "^[a-z]+:")
      continue()
    endif()
    if(EXISTS "${SOURCE}/${folder}/${path}")
      continue()
    endif()
    # Pages that are about to move to docs/results/ and docs/reference/.
    cmake_path(GET path FILENAME name)
    if(EXISTS "${SOURCE}/docs/${name}")
      continue()
    endif()
    violation("${page}: there is no file ${path}")
  endforeach()
  set(violations ${violations} PARENT_SCOPE)
endfunction()

function(check_width page text)
  string(REGEX REPLACE "[];[\\]" "," text "${text}") # as above
  string(REGEX MATCHALL "\n[^|\n][^\n]*" lines "${text}")
  foreach(line IN LISTS lines)
    string(LENGTH "${line}" length)
    if(length GREATER 121) # with its line feed
      string(SUBSTRING "${line}" 1 60 start)
      violation("${page}: a line has over 120 characters: ${start}...")
    endif()
  endforeach()
  set(violations ${violations} PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE pages RELATIVE "${SOURCE}" "${SOURCE}/docs/*.md")
if(EXISTS "${SOURCE}/README.md")
  list(PREPEND pages README.md)
endif()
foreach(page IN LISTS pages)
  file(READ "${SOURCE}/${page}" text)
  set(text "\n${text}")
  if(NOT page IN_LIST without_programs)
    check_blocks(${page} "${text}")
  endif()
  if(NOT page MATCHES "^docs/[a-z-]+[.]md$" OR NOT EXISTS "${SOURCE}/README.md") # not moved to a shelf yet
    check_links(${page} "${text}")
  endif()
  if(page MATCHES "^docs/(learn|reference)/")
    check_width(${page} "${text}")
  endif()
endforeach()
if(violations GREATER 0)
  message(FATAL_ERROR "documentation: ${violations} violations")
endif()
