# Writes the statistics of the readers' harnesses, from the logs that `fuzz` leaves in build/fuzz/tests/fuzz/:
#   cmake -D LOGS=build/fuzz/tests/fuzz -D OUTPUT=docs/results/fuzzing.md -P tests/fuzz/report.cmake
# Replaces the block of that page. Refuses a log with a finding: correct the reader, remove the log, and fuzz again.
# READERS: prints the rows of these readers, to be added to that page:
#   cmake -D LOGS=build/fuzz/tests/fuzz -D "READERS=hdr;exr" -P tests/fuzz/report.cmake
cmake_minimum_required(VERSION 3.25)

set(rows)
set(all 0)
set(all_seconds 0)
file(GLOB harnesses "${CMAKE_CURRENT_LIST_DIR}/*.cpp")
foreach(harness IN LISTS harnesses)
  get_filename_component(reader "${harness}" NAME_WE)
  if(DEFINED READERS AND NOT reader IN_LIST READERS)
    continue()
  endif()
  file(READ "${LOGS}/${reader}/log" log)
  if(log MATCHES "ERROR: |SUMMARY: ")
    message(FATAL_ERROR "${LOGS}/${reader}/log has a finding")
  endif()
  set(sum 0)
  set(seconds 0)
  set(slowest 0)
  set(memory 0)
  string(REGEX MATCHALL "stat::[a-z_]+: +[0-9]+" figures "${log}")
  foreach(figure IN LISTS figures)
    string(REGEX REPLACE "stat::([a-z_]+): +([0-9]+)" "\\1;\\2" pair "${figure}")
    list(GET pair 0 what)
    list(GET pair 1 number)
    if(what STREQUAL "number_of_executed_units")
      math(EXPR sum "${sum} + ${number}")
      set(executed ${number})
    elseif(what STREQUAL "average_exec_per_sec" AND number GREATER 0)
      math(EXPR seconds "${seconds} + ${executed} / ${number}")
    elseif(what STREQUAL "slowest_unit_time_sec" AND number GREATER slowest)
      set(slowest ${number})
    elseif(what STREQUAL "peak_rss_mb" AND number GREATER memory)
      set(memory ${number})
    endif()
  endforeach()
  file(GLOB corpus "${LOGS}/${reader}/corpus/*")
  list(LENGTH corpus kept)
  math(EXPR all "${all} + ${sum}")
  math(EXPR all_seconds "${all_seconds} + ${seconds}")
  string(APPEND rows "| `${reader}` | ${sum} | ${seconds} | ${kept} | ${slowest} | ${memory} |\n")
endforeach()

if(NOT DEFINED OUTPUT)
  execute_process(COMMAND "${CMAKE_COMMAND}" -E echo "${rows}| all | ${all} | ${all_seconds} | | | |")
  return()
endif()

string(TIMESTAMP today "%Y-%m-%d")
include("${CMAKE_CURRENT_LIST_DIR}/../../cmake/page_block.cmake")
write_block("${OUTPUT}" "cmake -P tests/fuzz/report.cmake" "end of report.cmake"
            "| reader | files read | seconds | files kept, as they reach new code | slowest, whole seconds | largest memory of the process, MB |
|---|---|---|---|---|---|
${rows}| all | ${all} | ${all_seconds} | | | |

Printed on ${today} by `cmake -P tests/fuzz/report.cmake`.
")
