# cmake -P cmake/test.cmake: installs missing packages, builds the compiled library, the tool and their tests with g++,
# and runs the tests. cmake/checks.cmake has the other checks, including the projects beside the library.
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")

gonio_set_up(${gonio_library_packages} ${gonio_test_packages})

# -O1 finishes first, because tests take longer to compile than to run.
step("configure" ${cmake} -S . -B build/test -G Ninja
     -D CMAKE_CXX_COMPILER=g++ -D CMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG"
     -D GONIO_BUILD_BENCH=OFF -D GONIO_TEST_CONSUMERS=OFF -D GONIO_UNITY_TOOL=ON)
step("build" ${cmake} --build build/test --parallel ${cores})
step("test" ${ctest} --test-dir build/test --label-exclude "kills|browser|webgl")
