# cmake -D TOOL=build/.../bin/gonio [-D CHECK=ON] -P cmake/tool_reference.cmake: writes docs/reference/tool.md, the help
# of each subcommand as the tool prints it, with lines of at most 120 characters. CHECK: fails if the page differs. A
# tool without `gonio shape` is compared with the rest of the page.
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/tool_help.cmake")
cmake_path(SET source NORMALIZE "${CMAKE_CURRENT_LIST_DIR}/..")
set(page "${source}/docs/reference/tool.md")
set(width 120)
set(indent "                              ") # indentation of the tool's descriptions
string(LENGTH "${indent}" indent_length)

# wrapped(RESULT TEXT): breaks long lines between words.
function(wrapped result text)
  set(out "")
  while(NOT text STREQUAL "")
    gonio_first_line(line text)
    string(LENGTH "${line}" length)
    while(length GREATER width)
      string(SUBSTRING "${line}" 0 ${width} start)
      string(FIND "${start}" " " blank REVERSE)
      if(blank LESS_EQUAL indent_length)
        message(FATAL_ERROR "this line of a help has a word that does not fit a line: ${line}")
      endif()
      string(SUBSTRING "${line}" 0 ${blank} start)
      string(APPEND out "${start}\n")
      math(EXPR blank "${blank} + 1")
      string(SUBSTRING "${line}" ${blank} -1 line)
      set(line "${indent}${line}")
      string(LENGTH "${line}" length)
    endwhile()
    string(APPEND out "${line}\n")
  endwhile()
  set(${result} "${out}" PARENT_SCOPE)
endfunction()

# describe(WORD...): adds the help of a subcommand, and of its own subcommands.
function(describe)
  gonio_tool_help(help "${TOOL}" ${ARGN})
  wrapped(text "${help}")
  string(JOIN " " name gonio ${ARGN})
  set_property(GLOBAL APPEND_STRING PROPERTY text "\n## ${name}\n\n```\n${text}```\n")
  gonio_subcommands(subcommands "${help}")
  foreach(subcommand IN LISTS subcommands)
    describe(${ARGN} ${subcommand})
  endforeach()
endfunction()

# without_shape(TEXT): removes gonio shape and its subcommands from the text in a variable.
function(without_shape variable)
  string(REGEX REPLACE "\n  shape  [^\n]*" "" text "${${variable}}")
  string(REGEX REPLACE "\n(## gonio shape[^#]*)+" "" text "${text}")
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

set_property(GLOBAL PROPERTY text "# The options of the tool

What `gonio --help` and `gonio SUBCOMMAND --help` print. Written by `cmake -D TOOL=build/.../bin/gonio -P
cmake/tool_reference.cmake`; the tests compare it. Angles on the command line are degrees. `gonio` ends with exit code 2
and one sentence if its input is bad.
")
describe()
get_property(text GLOBAL PROPERTY text)

set(has_shape ON)
if(text MATCHES "## gonio shape\n\n```\n.not in this build.")
  set(has_shape OFF)
endif()
if(NOT CHECK)
  if(NOT has_shape)
    message(FATAL_ERROR "${TOOL} has no gonio shape: build it with -D GONIO_BUILD_SHAPE=ON")
  endif()
  file(WRITE "${page}" "${text}")
  return()
endif()
set(present "")
if(EXISTS "${page}")
  file(READ "${page}" present)
endif()
if(NOT has_shape)
  without_shape(text)
  without_shape(present)
endif()
if(NOT present STREQUAL text)
  message(FATAL_ERROR "docs/reference/tool.md is not what the tool prints now; write it again: "
                      "cmake -D TOOL=${TOOL} -P cmake/tool_reference.cmake")
endif()
