# cmake -D PROGRAM=... -D TOOL=... -D SOURCE=... -D SCRATCH=... -P same_bytes.cmake: fails unless README's header-only
# program and `gonio reconstruct` write the same bytes from the same samples, one of which is wrong. The material is a
# measured one if ../shared/data exists, otherwise a formula's.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE "${SCRATCH}")
file(MAKE_DIRECTORY "${SCRATCH}")
configure_file("${SOURCE}/examples/data/materials.prior" "${SCRATCH}/materials.prior" COPYONLY)

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY "${SCRATCH}" OUTPUT_QUIET ERROR_VARIABLE said
                  COMMAND_ERROR_IS_FATAL ANY)
  set(said "${said}" PARENT_SCOPE)
endfunction()

set(truth "${SOURCE}/../shared/data/rgl-measured/satin_purple_rgb.binary.gz")
if(NOT EXISTS "${truth}")
  file(GLOB truth "${SOURCE}/../shared/data/rgl-measured/satin*.binary.gz")
endif()
if(NOT truth)
  message("no measured material in ../shared/data: a formula's is taken")
  set(truth "${SCRATCH}/truth.binary")
  run("${TOOL}" expand --formula red-paint -o truth.binary)
endif()
run("${TOOL}" sample "${truth}" --directions "${SOURCE}/examples/data/nielsen-20.csv" -o right.csv)

# Sample 7 is a hundred times too bright.
file(STRINGS "${SCRATCH}/right.csv" lines)
set(number 0)
set(text "")
foreach(line IN LISTS lines)
  if(line MATCHES "^[-+0-9]")
    math(EXPR number "${number} + 1")
    if(number EQUAL 7)
      string(REGEX REPLACE ",[^,]+,[^,]+,[^,]+$" ",99,98,97" line "${line}")
    endif()
  endif()
  string(APPEND text "${line}\n")
endforeach()
file(WRITE "${SCRATCH}/measurements.csv" "${text}")

run("${PROGRAM}")
run("${TOOL}" reconstruct measurements.csv --prior materials.prior -o tool.binary)
if(NOT said MATCHES "sample 7 disagrees and is left out")
  message(FATAL_ERROR "the wrong sample was not found: ${said}")
endif()
run("${CMAKE_COMMAND}" -E compare_files paint.binary tool.binary)
