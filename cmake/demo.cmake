# cmake -P cmake/demo.cmake: builds a gonio tool with the subcommands needed here. Measures a known material in 20
# directions, reconstructs it, draws the result and compares it with the truth.
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")
set(results "${source}/build/demo-results")

gonio_set_up(${gonio_library_packages})

# With -O1 the tool builds in a tenth less time and runs as fast, because the slow loops are vectorised by hand.
message("-- Building the gonio tool")
execute_process(COMMAND "${CMAKE_COMMAND}" -S "${source}" -B "${source}/build/demo" -G Ninja
                        -D CMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG" -D GONIO_NATIVE=ON
                        -D GONIO_BUILD_TESTS=OFF -D GONIO_BUILD_BENCH=OFF -D GONIO_UNITY_TOOL=ON
                        "-DGONIO_TOOL_COMMANDS=expand;sample;reconstruct;render;compare"
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${CMAKE_COMMAND}" --build "${source}/build/demo" --target gonio_tool
                        --parallel ${cores}
                COMMAND_ERROR_IS_FATAL ANY)

# gonio(LINE): prints a command line and runs it.
function(gonio line)
  message("\n$ gonio ${line}")
  separate_arguments(arguments UNIX_COMMAND "${line}")
  execute_process(COMMAND "${source}/build/demo/bin/gonio" ${arguments} ${ARGN}
                  WORKING_DIRECTORY "${results}"
                  COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(MAKE_DIRECTORY "${results}")
message("\n$ cd build/demo-results\n$ export PATH=$PWD/../demo/bin:$PATH")
gonio("expand --formula red-paint -o truth.binary")
gonio("sample truth.binary --directions ../../examples/data/nielsen-20.csv -o samples.csv")
gonio("reconstruct samples.csv -o estimate.binary")
gonio("render estimate.binary truth.binary --size 256 -o spheres.png")
gonio("render estimate.binary truth.binary --slices --size 256 -o slices.png")
gonio("compare estimate.binary truth.binary --json" OUTPUT_FILE "${results}/errors.json")
file(READ "${results}/errors.json" errors)
message("${errors}")

message("The results are in ${results}:
  estimate.binary  the reconstructed table; truth.binary is the one it was measured from
  spheres.png      the estimate beside the truth, under two lights
  slices.png       the estimate beside the truth, slices at phi_d = 90 degrees
  errors.json      the errors printed above")
