# Installs BUILD_DIR into an empty prefix, then builds and runs projects that know only that prefix.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE "${SCRATCH}")

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# build_and_run(PROJECT BUILD [OPTION...]): the project's folder here, where to build it below SCRATCH, and what else its
# configuration is told.
function(build_and_run project build)
  run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}/${project}" -B "${SCRATCH}/${build}"
      -G "${GENERATOR}"
      -D "CMAKE_CXX_COMPILER=${COMPILER}"
      -D "CMAKE_BUILD_TYPE=${CONFIG}"
      -D "CMAKE_PREFIX_PATH=${SCRATCH}/prefix"
      ${ARGN})
  run("${CMAKE_COMMAND}" --build "${SCRATCH}/${build}" --config "${CONFIG}")
  run("${CMAKE_CTEST_COMMAND}" --test-dir "${SCRATCH}/${build}" -C "${CONFIG}" --output-on-failure --no-tests=error)
endfunction()

run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --config "${CONFIG}" --prefix "${SCRATCH}/prefix")

# As on a machine without dlib and nanoflann, which this one has: a search for either fails. CMake warns of options
# that nobody read, and that is what these should be.
build_and_run(consumer build --no-warn-unused-cli
              -D CMAKE_DISABLE_FIND_PACKAGE_dlib=ON
              -D CMAKE_DISABLE_FIND_PACKAGE_Nanoflann=ON)
build_and_run(shape_consumer shape_build)
