# gonio_set_up(PACKAGE...) installs the Debian packages that are missing. It looks for one file of each package, not for
# the package: the file may come from another source.

# Debian's packages for a build, and those that only shapes need. BLAS and LAPACK are listed, because dlib's CMake
# configuration needs them but its package does not depend on them.
set(gonio_library_packages
  g++ ninja-build libeigen3-dev libxtensor-dev zlib1g-dev libstb-dev libcli11-dev nlohmann-json3-dev)
set(gonio_shape_packages libdlib-dev libblas-dev liblapack-dev libnanoflann-dev)
set(gonio_python_packages pybind11-dev python3-dev python3-numpy python3-matplotlib python3-venv)
set(gonio_mpi_packages libopenmpi-dev openmpi-bin)
set(gonio_test_packages doctest-dev librapidcheck-dev libopenexr-dev libtiff-dev libexif-dev libnanoflann-dev)

# package, kind and name of the file that stands for it
set(gonio_packages
  "g++                 program g++"
  "ninja-build         program ninja"
  "time                program time"
  "clang-19            program clang++-19"
  "clang-format-14     program clang-format-14"
  "codespell           program codespell"
  "libclang-rt-19-dev  header  sanitizer/asan_interface.h"
  "libc++-19-dev       header  c++/v1/vector"
  "libc++abi-19-dev    header  c++/v1/cxxabi.h"
  "lld-19              program wasm-ld-19"
  "wasi-libc           header  wasm32-wasi/wasi/api.h"
  "libclang-rt-19-dev-wasm32 header llvm-19/lib/clang/19/lib/wasi/libclang_rt.builtins-wasm32.a"
  "libc++-19-dev-wasm32 header wasm32-wasi/c++/v1/vector"
  "libc++abi-19-dev-wasm32 header wasm32-wasi/c++/v1/cxxabi.h"
  "libeigen3-dev       header  eigen3/Eigen/Core"
  "libxtensor-dev      header  xtensor/xtensor.hpp"
  "zlib1g-dev          header  zlib.h"
  "libstb-dev          header  stb/stb_image_write.h"
  "libopenexr-dev      header  OpenEXR/ImfInputFile.h"
  "libtiff-dev         header  tiffio.h"
  "libexif-dev         header  libexif/exif-data.h"
  "libcli11-dev        header  CLI/CLI.hpp"
  "nlohmann-json3-dev  header  nlohmann/json.hpp"
  "libdlib-dev         header  dlib/optimization/max_cost_assignment.h"
  "libblas-dev         library blas"
  "liblapack-dev       library lapack"
  "libnanoflann-dev    header  nanoflann.hpp"
  "pybind11-dev        header  pybind11/pybind11.h"
  "python3-dev         header  python3.11/Python.h"
  "python3-numpy       program dh_numpy3"
  "python3-matplotlib  header  python3/dist-packages/matplotlib/pyplot.py"
  "python3-venv        header  python3.11/ensurepip/__init__.py"
  "libopenmpi-dev      header  openmpi/include/mpi.h"
  "openmpi-bin         program mpirun"
  "doctest-dev         header  doctest/doctest.h"
  "librapidcheck-dev   header  rapidcheck.h"
  "libbenchmark-dev    header  benchmark/benchmark.h"
  "g++-mingw-w64-x86-64-posix program x86_64-w64-mingw32-g++-posix"
  "libz-mingw-w64-dev  header  ../x86_64-w64-mingw32/include/zlib.h"
  "wine                program wine"
  "wine64              header  x86_64-linux-gnu/wine/x86_64-unix/ntdll.so"
  "file                program file"
  "dpkg-dev            program dpkg-source"
  "mkdocs              program mkdocs"
  "mkdocs-material     header  mkdocs/themes/material/main.html"
  "doxygen             program doxygen"
  "linkchecker         program linkchecker"
  "chromium            program chromium"
  "nodejs              program node"
  "npm                 program npm")

# gonio_find_missing(RESULT PACKAGE...): returns the packages whose file is missing.
function(gonio_find_missing result)
  set(missing)
  foreach(entry IN LISTS gonio_packages)
    string(REGEX MATCHALL "[^ ]+" fields "${entry}")
    list(POP_FRONT fields package kind name)
    if(NOT package IN_LIST ARGN)
      continue()
    endif()
    if(kind STREQUAL "program")
      find_program(found NAMES ${name} NO_CACHE)
    elseif(kind STREQUAL "library")
      find_library(found NAMES ${name} NO_CACHE PATHS /usr/lib/x86_64-linux-gnu /usr/lib/aarch64-linux-gnu)
    else()
      find_path(found NAMES ${name} NO_CACHE
                PATHS /usr/include /usr/include/x86_64-linux-gnu /usr/include/aarch64-linux-gnu /usr/local/include /usr/lib /usr/share
                      /usr/lib/x86_64-linux-gnu /usr/lib/aarch64-linux-gnu
                      /usr/lib/llvm-19/include /usr/lib/llvm-19/lib/clang/19/include)
    endif()
    if(NOT found)
      list(APPEND missing ${package})
    endif()
    unset(found)
  endforeach()
  set(${result} ${missing} PARENT_SCOPE)
endfunction()

function(gonio_set_up)
  gonio_find_missing(missing ${ARGN})
  if(NOT missing)
    return()
  endif()
  list(JOIN missing " " names)

  # Root installs directly, other users through sudo if it asks for no password.
  find_program(apt_get apt-get NO_CACHE)
  execute_process(COMMAND id -u OUTPUT_VARIABLE user OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(as_root)
  if(NOT user STREQUAL "0")
    set(as_root sudo -n)
    execute_process(COMMAND sudo -n true RESULT_VARIABLE no_sudo OUTPUT_QUIET ERROR_QUIET)
  endif()
  if(NOT apt_get OR no_sudo)
    message(FATAL_ERROR "Please install what these Debian packages contain, then run this again: ${names}")
  endif()

  message("-- Installing ${names}")
  set(install ${as_root} env DEBIAN_FRONTEND=noninteractive apt-get -qq)
  execute_process(COMMAND ${install} update)
  execute_process(COMMAND ${install} install --no-install-recommends ${missing}
                  RESULT_VARIABLE failed OUTPUT_QUIET)
  gonio_find_missing(missing ${ARGN})
  if(failed OR missing)
    message(FATAL_ERROR "apt-get could not install: ${names}")
  endif()
endfunction()
