# cmake -P cmake/test.cmake: installs what is missing, then builds the library once, the tool and their tests with g++, and
# passes them. `.ci/run` has the rest, the projects beside the library among it: cmake/checks.cmake.
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")

gonio_set_up(${gonio_library_packages} ${gonio_test_packages})

# The optimisation that runs soonest: tests compile longer than they run.
step("configure" ${cmake} -S . -B build/test -G Ninja
     -D CMAKE_CXX_COMPILER=g++ -D CMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG"
     -D GONIO_BUILD_BENCH=OFF -D GONIO_TEST_CONSUMERS=OFF)
step("build" ${cmake} --build build/test --parallel ${cores})
step("test" ${ctest} --test-dir build/test --label-exclude "kills|browser|webgl")
