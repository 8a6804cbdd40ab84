# cmake -D PREFIX=/where -P cmake/install_headers.cmake: installs the headers, the prior and the directions, without
# compiling. Needs the libraries of the headers (Eigen, xtensor, zlib), but no library of tests or tool.
cmake_minimum_required(VERSION 3.25)
if(NOT PREFIX)
  message(FATAL_ERROR "PREFIX is missing: cmake -D PREFIX=/usr/local -P cmake/install_headers.cmake")
endif()
cmake_path(ABSOLUTE_PATH PREFIX BASE_DIRECTORY "$ENV{PWD}" NORMALIZE)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH source)
set(build "${source}/build/headers")
execute_process(COMMAND "${CMAKE_COMMAND}" -S "${source}" -B "${build}" -D "CMAKE_INSTALL_PREFIX=${PREFIX}"
  -D GONIO_BUILD_COMPILED=OFF -D GONIO_BUILD_TESTS=OFF -D GONIO_BUILD_EXAMPLES=OFF -D GONIO_BUILD_BENCH=OFF
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${build}" COMMAND_ERROR_IS_FATAL ANY)
