# cmake [-D COMPILER=g++] -P cmake/compile_times.cmake: the seconds that each public header costs a file that
# includes nothing else, optimised, beside Eigen's Core.
cmake_minimum_required(VERSION 3.25)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH source)
if(NOT COMPILER)
  set(COMPILER g++)
endif()
set(scratch "${source}/build/compile_times")
file(MAKE_DIRECTORY "${scratch}")
file(GLOB_RECURSE headers RELATIVE "${source}/include" "${source}/include/gonio/*.hpp")
foreach(header IN ITEMS Eigen/Core xtensor/xtensor.hpp LISTS headers)
  file(WRITE "${scratch}/one.cpp" "#include <${header}>\n")
  string(TIMESTAMP start "%s%f")
  execute_process(COMMAND "${COMPILER}" -std=c++20 -O2 "-I${source}/include" -isystem /usr/include/eigen3
                          -c "${scratch}/one.cpp" -o "${scratch}/one.o" COMMAND_ERROR_IS_FATAL ANY)
  string(TIMESTAMP end "%s%f")
  math(EXPR milliseconds "(${end} - ${start}) / 1000")
  message("${milliseconds} ms  ${header}")
endforeach()
