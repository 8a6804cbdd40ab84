# Prints the quick tables of docs/results again and compares:
#   cmake -D SOURCE=. -D SHARED=../shared/data -D PAPERS=build/bin/gonio-papers -D SCRATCH=build/results
#         -P tests/documentation/results.cmake
# The quick tables are all blocks of quick.md, and those named below. Runs each command with --markdown on a copy of its
# page. Only the line with the date may differ. Skips commands whose data are missing.
cmake_minimum_required(VERSION 3.25)

set(results "${SOURCE}/docs/results")
file(STRINGS "${results}/quick.md" lines REGEX "^<!-- gonio-papers ")
set(quick "")
foreach(line IN LISTS lines)
  string(REGEX REPLACE "^<!-- gonio-papers (.*) -->$" "quick.md|\\1" entry "${line}")
  list(APPEND quick "${entry}")
endforeach()
list(APPEND quick "models.md|model-recovery" "spectra.md|spectra --samples garnet_red.brdf krylon_blue.brdf")

# resolve(RESULT WORD): returns the path of a file or folder that a command names; nothing if it is missing; any other
# word unchanged.
function(resolve result word)
  set(${result} "${word}" PARENT_SCOPE)
  if(NOT word MATCHES "[.](npy|hdr|gz|binary|brdf|csv|prior)$" AND NOT word STREQUAL "rgl-measured")
    return()
  endif()
  file(GLOB found "${SHARED}/${word}" "${SHARED}/*/${word}" "${SOURCE}/examples/data/${word}"
    "${SOURCE}/examples/data/*/${word}")
  list(POP_FRONT found first) # empty if nothing was found
  set(${result} "${first}" PARENT_SCOPE)
endfunction()

# read_tables(RESULT PAGE): returns a page without the lines that say when a block was printed.
function(read_tables result page)
  file(READ "${page}" text)
  string(REGEX REPLACE "\nPrinted on [^<]*<!-- end of " "\n<!-- end of " text "${text}")
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

file(MAKE_DIRECTORY "${SCRATCH}")
set(differing 0)
set(compared 0)
foreach(entry IN LISTS quick)
  string(REGEX MATCH "^([^|]*)[|](.*)$" all "${entry}")
  set(page "${CMAKE_MATCH_1}")
  set(command "${CMAKE_MATCH_2}")
  separate_arguments(words UNIX_COMMAND "${command}")
  set(arguments "")
  set(missing "")
  foreach(word IN LISTS words)
    resolve(argument "${word}")
    if(argument STREQUAL "")
      set(missing "${word}")
    endif()
    list(APPEND arguments "${argument}")
  endforeach()
  if(missing)
    message(STATUS "left out, as ${missing} is not there: gonio-papers ${command}")
    continue()
  endif()
  file(COPY "${results}/${page}" DESTINATION "${SCRATCH}")
  execute_process(COMMAND "${PAPERS}" ${arguments} --markdown "${SCRATCH}/${page}"
    RESULT_VARIABLE failed OUTPUT_VARIABLE printed ERROR_VARIABLE complaint)
  if(failed)
    message(SEND_ERROR "gonio-papers ${command}: ${complaint}")
    math(EXPR differing "${differing} + 1")
    continue()
  endif()
  math(EXPR compared "${compared} + 1")
  read_tables(kept "${results}/${page}")
  read_tables(again "${SCRATCH}/${page}")
  if(NOT kept STREQUAL again)
    message(SEND_ERROR "docs/results/${page} has not what gonio-papers ${command} prints:\n${printed}")
    math(EXPR differing "${differing} + 1")
  endif()
endforeach()
message(STATUS "results: ${compared} commands printed again, ${differing} differ")
if(compared EQUAL 0)
  message(FATAL_ERROR "no command was run")
endif()
