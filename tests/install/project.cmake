# Configures, builds and tests a project beside the library in BUILD. The project sees only the gonio installed in PREFIX:
# cmake -D PROJECT=shape -D BUILD=... -D PREFIX=... -D GENERATOR=Ninja -D COMPILER=g++ -D CONFIG=Release -D "FLAGS=-O1"
# [-D LABELS=regex] [-D INSTALL=ON] -P project.cmake. INSTALL also installs the project in PREFIX.
cmake_minimum_required(VERSION 3.25)
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run("${CMAKE_COMMAND}" -S "${PROJECT}" -B "${BUILD}" -G "${GENERATOR}" -D "CMAKE_CXX_COMPILER=${COMPILER}"
    -D "CMAKE_BUILD_TYPE=${CONFIG}" -D "CMAKE_CXX_FLAGS_RELEASE=${FLAGS}" -D "CMAKE_PREFIX_PATH=${PREFIX}")
run("${CMAKE_COMMAND}" --build "${BUILD}" --config "${CONFIG}" --parallel ${cores})
run("${CMAKE_CTEST_COMMAND}" --test-dir "${BUILD}" -C "${CONFIG}" --output-on-failure --no-tests=error --parallel ${cores})
if(INSTALL)
  run("${CMAKE_COMMAND}" --install "${BUILD}" --config "${CONFIG}" --prefix "${PREFIX}")
endif()
