# cmake -P cmake/test.cmake: installs what is missing, then builds and passes every test.
# cmake -DGONIO_ONLY=gcc|clang|format -P cmake/test.cmake: one of the three parts.
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/setup.cmake")
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH source)

set(parts gcc clang format)
if(GONIO_ONLY)
  if(NOT GONIO_ONLY IN_LIST parts)
    message(FATAL_ERROR "GONIO_ONLY is one of gcc, clang, format")
  endif()
  set(parts ${GONIO_ONLY})
endif()

set(build_packages
  g++ ninja-build libeigen3-dev libxtensor-dev zlib1g-dev libstb-dev libcli11-dev
  nlohmann-json3-dev libdlib-dev libnanoflann-dev doctest-dev librapidcheck-dev libbenchmark-dev)
set(gcc_packages ${build_packages})
set(clang_packages ${build_packages} clang-19 libclang-rt-19-dev)
set(format_packages clang-format-14)

# step(NAME COMMAND...) runs a command, tells the seconds it took, and stops everything if it fails.
function(step name)
  message("\n== ${name}")
  string(TIMESTAMP start "%s")
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY "${source}" RESULT_VARIABLE failed)
  string(TIMESTAMP end "%s")
  math(EXPR seconds "${end} - ${start}")
  if(failed)
    message(FATAL_ERROR "${name} failed after ${seconds} s")
  endif()
  message("== ${name}: ${seconds} s")
endfunction()

cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
set(cmake "${CMAKE_COMMAND}")
set(ctest "${CMAKE_CTEST_COMMAND}" --output-on-failure --no-tests=error --parallel ${cores})

foreach(part IN LISTS parts)
  gonio_set_up(${${part}_packages})
endforeach()

if("gcc" IN_LIST parts)
  set(dir build/test-gcc)
  # The tool takes twice as long to compile at -O3, which is how the demo builds it; the benchmarks, which the preset
  # 'release' builds, as long as half of the tests.
  step("g++: configure" ${cmake} -S . -B ${dir} -G Ninja
       -D CMAKE_CXX_COMPILER=g++ -D CMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG"
       -D GONIO_BUILD_BENCH=OFF
       -D GONIO_TEST_HEADERS_ALONE=OFF) # the clang half compiles them, in half the time
  step("g++: build" ${cmake} --build ${dir} --parallel ${cores})
  step("g++: test" ${ctest} --test-dir ${dir})
  # Printed, not judged: a machine that does something else would fail it. The aim is a second more than Eigen's Core.
  step("g++: compile time of gonio/render.hpp" ${cmake} -D HEADERS=gonio/render.hpp -P cmake/compile_times.cmake)
endif()

if("clang" IN_LIST parts)
  set(dir build/test-clang)
  step("clang, sanitized: configure" ${cmake} --preset sanitize -B ${dir} -D GONIO_TEST_HEADERS_ALONE=ON)
  step("clang, sanitized: build" ${cmake} --build ${dir} --parallel ${cores})
  step("clang, sanitized: test" ${ctest} --preset sanitize --test-dir ${dir})
endif()

if("format" IN_LIST parts)
  set(sources)
  foreach(folder IN ITEMS include examples tests bench docs)
    file(GLOB_RECURSE found "${source}/${folder}/*.hpp" "${source}/${folder}/*.cpp")
    list(APPEND sources ${found})
  endforeach()
  step("clang-format" clang-format-14 --dry-run -Werror ${sources})
endif()
