# cmake -D SCRATCH=build/windows -P tests/install/windows.cmake: cross-compiles a renderer's program and README's
# program with MinGW, and runs both with Wine.
cmake_minimum_required(VERSION 3.25)
cmake_path(ABSOLUTE_PATH SCRATCH NORMALIZE)
file(REMOVE_RECURSE "${SCRATCH}")

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run("${CMAKE_COMMAND}" -D "PREFIX=${SCRATCH}/headers" -P "${CMAKE_CURRENT_LIST_DIR}/../../cmake/install_headers.cmake")

# Link xtensor's headers into a separate folder: MinGW must not find the headers of Linux's C library in /usr/include.
file(MAKE_DIRECTORY "${SCRATCH}/include")
foreach(package IN ITEMS xtensor xtl)
  file(CREATE_LINK "/usr/include/${package}" "${SCRATCH}/include/${package}" SYMBOLIC)
endforeach()
file(WRITE "${SCRATCH}/xtensor-config.cmake" "add_library(xtensor INTERFACE IMPORTED)
target_include_directories(xtensor INTERFACE \"${SCRATCH}/include\")\n")
file(WRITE "${SCRATCH}/xtensor-config-version.cmake" "set(PACKAGE_VERSION_COMPATIBLE TRUE)\n")

set(ENV{WINEPREFIX} "${SCRATCH}/wine")
set(ENV{WINEDEBUG} -all)
foreach(project IN ITEMS render_consumer first_program)
  run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}/${project}" -B "${SCRATCH}/${project}" -G Ninja
      -D CMAKE_SYSTEM_NAME=Windows -D CMAKE_CXX_COMPILER=x86_64-w64-mingw32-g++-posix -D CMAKE_BUILD_TYPE=Release
      -D "CMAKE_FIND_ROOT_PATH=/usr/x86_64-w64-mingw32" -D CMAKE_EXE_LINKER_FLAGS=-static
      -D CMAKE_CROSSCOMPILING_EMULATOR=wine -D "xtensor_DIR=${SCRATCH}" -D ZLIB_USE_STATIC_LIBS=ON
      -D "gonio_DIR=${SCRATCH}/headers/share/cmake/gonio" -D Eigen3_DIR=/usr/share/eigen3/cmake)
  run("${CMAKE_COMMAND}" --build "${SCRATCH}/${project}")
  run("${CMAKE_CTEST_COMMAND}" --test-dir "${SCRATCH}/${project}" --output-on-failure --no-tests=error)
endforeach()
