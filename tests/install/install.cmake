# Installs BUILD_DIR into an empty PREFIX, which projects then know alone.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE "${PREFIX}")
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${BUILD_DIR}" --config "${CONFIG}" --prefix "${PREFIX}"
                COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
