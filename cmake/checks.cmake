# cmake [-D ONLY=format|weight|site|bundle|others|libcxx|sanitize|wheel|debian|release|windows] -P cmake/checks.cmake:
# runs the checks of CI that cmake/test.cmake does not, or one of them. Four run only if named, for releases: a Python
# wheel, which needs PyPI; Debian packages; the static program, which needs Debian's sources; programs for Windows, by
# MinGW and Wine.
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")

set(parts format weight site bundle others libcxx sanitize)
if(ONLY)
  if(NOT ONLY IN_LIST parts AND NOT ONLY MATCHES "^(wheel|debian|release|windows)$")
    message(FATAL_ERROR "ONLY is one of ${parts};wheel;debian;release;windows")
  endif()
  set(parts ${ONLY})
endif()
gonio_set_up(${gonio_library_packages} ${gonio_shape_packages} ${gonio_test_packages} ${gonio_python_packages}
             ${gonio_mpi_packages} wasi-libc lld-19 libclang-rt-19-dev-wasm32 libc++-19-dev-wasm32 libc++abi-19-dev-wasm32
             clang-19 libclang-rt-19-dev libc++-19-dev libc++abi-19-dev clang-format-14 codespell time)

if("format" IN_LIST parts)
  set(sources)
  foreach(folder IN ITEMS include src examples tests bench docs shape mpi)
    file(GLOB_RECURSE found "${source}/${folder}/*.hpp" "${source}/${folder}/*.ipp" "${source}/${folder}/*.cpp")
    list(APPEND sources ${found})
  endforeach()
  step("clang-format" clang-format-14 --dry-run -Werror ${sources})
  step("codespell" codespell) # .codespellrc lists the files and the permitted words
endif()

# Compile times: fails if README's program or gonio.hpp costs its compiler 30 % more than its limit.
if("weight" IN_LIST parts)
  step("weight" ${cmake} -D GUARD=ON -P cmake/compile_times.cmake)
endif()

# The site: fails for a dead link, and for a docstring that Doxygen does not understand.
if("site" IN_LIST parts)
  step("site" ${cmake} -P cmake/site.cmake)
endif()

# The scripts of gonio report's page: if npm and its registry are available, bundles the locked versions again and
# compares with the committed files.
if("bundle" IN_LIST parts)
  include("${CMAKE_CURRENT_LIST_DIR}/bundle.cmake")
endif()

# In the build of cmake/test.cmake: header-only programs, 50 kills of each long command, the Python module, and pages in
# a browser. Also projects that see only the installed package: a reader's, and those beside the library with their
# tests (shape, mpi, the quick experiments of the papers, the programs of examples/learn, the lessons).
if("others" IN_LIST parts)
  include("${CMAKE_CURRENT_LIST_DIR}/browser.cmake")
  step("others: configure" ${cmake} -S . -B build/test -G Ninja
       -D CMAKE_CXX_COMPILER=g++ -D CMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG"
       -D GONIO_BUILD_BENCH=OFF -D GONIO_TEST_CONSUMERS=ON -D GONIO_UNITY_TOOL=ON
       -D GONIO_BUILD_PYTHON=ON -D Python_EXECUTABLE=/usr/bin/python3)
  step("others: build" ${cmake} --build build/test --parallel ${cores})
  step("others: test" ${ctest} --test-dir build/test --label-regex "consumers|projects|kills|python|browser")
endif()

# Clang with libc++: the library, the tool, and the tests of numbers and threads, in which standard libraries differ.
if("libcxx" IN_LIST parts)
  set(tested core table io)
  list(TRANSFORM tested PREPEND test_ OUTPUT_VARIABLE targets)
  step("libc++: configure" ${cmake} --preset libcxx)
  step("libc++: build" ${cmake} --build build/libcxx --parallel ${cores} --target gonio_tool ${targets})
  list(JOIN tested "|" tested)
  step("libc++: test" ${ctest} --test-dir build/libcxx --tests-regex "^(${tested}|help_offers_formats)$")
endif()

if("sanitize" IN_LIST parts)
  set(dir build/sanitize)
  step("clang, sanitized: configure" ${cmake} --preset sanitize -B ${dir} -D GONIO_TEST_HEADERS_ALONE=ON
       -D GONIO_BUILD_SHAPE=ON -D GONIO_TEST_CONSUMERS=OFF)
  step("clang, sanitized: build" ${cmake} --build ${dir} --parallel ${cores})
  step("clang, sanitized: test" ${ctest} --preset sanitize --test-dir ${dir})
endif()

if("wheel" IN_LIST parts)
  step("wheel" ${cmake} -D PYTHON=/usr/bin/python3 -D SOURCE=${source} -D SCRATCH=${source}/build/wheel
       -P tests/python/wheel.cmake)
endif()

if("debian" IN_LIST parts)
  step("debian" ${cmake} -D CHECK=ON -P cmake/debian.cmake)
endif()

if("release" IN_LIST parts)
  step("release" ${cmake} -P cmake/release.cmake)
endif()

if("windows" IN_LIST parts)
  gonio_set_up(g++-mingw-w64-x86-64-posix libz-mingw-w64-dev wine wine64)
  step("windows" ${cmake} -D SCRATCH=${source}/build/windows -P tests/install/windows.cmake)
endif()
