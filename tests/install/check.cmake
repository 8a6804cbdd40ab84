# Installs BUILD_DIR into an empty prefix, then builds and runs a project that knows only that prefix.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE "${SCRATCH}")

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --config "${CONFIG}" --prefix "${SCRATCH}/prefix")
run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}/consumer" -B "${SCRATCH}/build"
    -G "${GENERATOR}"
    -D "CMAKE_CXX_COMPILER=${COMPILER}"
    -D "CMAKE_BUILD_TYPE=${CONFIG}"
    -D "CMAKE_PREFIX_PATH=${SCRATCH}/prefix")
run("${CMAKE_COMMAND}" --build "${SCRATCH}/build" --config "${CONFIG}")
run("${CMAKE_CTEST_COMMAND}" --test-dir "${SCRATCH}/build" -C "${CONFIG}" --output-on-failure)
