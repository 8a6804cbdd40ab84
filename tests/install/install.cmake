# Installs BUILD_DIR into an empty PREFIX, the only gonio that the tested projects see.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE "${PREFIX}")
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${BUILD_DIR}" --config "${CONFIG}" --prefix "${PREFIX}"
                COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
