# Builds and runs programs and projects that see only a gonio installed in PREFIX, or in a prefix with only its headers.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE "${SCRATCH}/build" "${SCRATCH}/shape_build" "${SCRATCH}/render_build"
     "${SCRATCH}/render_directory_build" "${SCRATCH}/headers")

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# build_and_run(PROJECT BUILD [OPTION...]): configures the project in the folder PROJECT here with the options, in BUILD
# below SCRATCH, builds it and runs its tests.
function(build_and_run project build)
  run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}/${project}" -B "${SCRATCH}/${build}"
      -G "${GENERATOR}"
      -D "CMAKE_CXX_COMPILER=${COMPILER}"
      -D "CMAKE_BUILD_TYPE=${CONFIG}"
      -D "CMAKE_PREFIX_PATH=${PREFIX}"
      ${ARGN})
  run("${CMAKE_COMMAND}" --build "${SCRATCH}/${build}" --config "${CONFIG}")
  run("${CMAKE_CTEST_COMMAND}" --test-dir "${SCRATCH}/${build}" -C "${CONFIG}" --output-on-failure --no-tests=error)
endfunction()

function(ask_pkg_config result)
  execute_process(COMMAND pkg-config ${ARGN} OUTPUT_VARIABLE answer OUTPUT_STRIP_TRAILING_WHITESPACE
                  COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(answer)
  set(${result} ${answer} PARENT_SCOPE)
endfunction()

# build_with_pkg_config(PACKAGE PREFIX): compiles README's program with the flags of pkg-config, and runs it.
function(build_with_pkg_config package prefix)
  file(GLOB folders "${prefix}/lib/pkgconfig" "${prefix}/lib/*/pkgconfig" "${prefix}/share/pkgconfig")
  list(JOIN folders ":" path)
  set(ENV{PKG_CONFIG_PATH} "${path}")
  ask_pkg_config(cflags --cflags ${package})
  ask_pkg_config(libs --libs ${package})
  ask_pkg_config(prior --variable=prior gonio)
  set(program "${SCRATCH}/${package}")
  set(examples "${CMAKE_CURRENT_LIST_DIR}/../../examples")
  run("${COMPILER}" -std=c++20 -O1 ${cflags} "${examples}/learn/first_program.cpp" -o "${program}.out" ${libs})
  file(COPY "${examples}/data/measurements.csv" "${prior}" DESTINATION "${program}")
  run("${CMAKE_COMMAND}" -E chdir "${program}" "${program}.out")
endfunction()

run("${CMAKE_COMMAND}" -D "PREFIX=${SCRATCH}/headers" -P "${CMAKE_CURRENT_LIST_DIR}/../../cmake/install_headers.cmake")
foreach(file IN ITEMS include/gonio/gonio.hpp share/gonio/materials.prior share/doc/gonio/LICENSE)
  if(NOT EXISTS "${SCRATCH}/headers/${file}")
    message(FATAL_ERROR "${file} is not installed")
  endif()
endforeach()
find_program(pkg_config pkg-config NO_CACHE)
if(pkg_config)
  build_with_pkg_config(gonio "${SCRATCH}/headers")
  if(EXISTS "${BUILD_DIR}/gonio-compiled.pc")
    build_with_pkg_config(gonio-compiled "${PREFIX}")
  endif()
endif()

# As on a machine without dlib and nanoflann: a search for either fails. If nothing searches, CMake would warn of unused
# options.
build_and_run(consumer build --no-warn-unused-cli
              -D CMAKE_DISABLE_FIND_PACKAGE_dlib=ON
              -D CMAKE_DISABLE_FIND_PACKAGE_Nanoflann=ON)
# A renderer with only Eigen: with the installed gonio, and with gonio as a subdirectory.
build_and_run(render_consumer render_build)
build_and_run(render_consumer render_directory_build -D "GONIO_SOURCE=${CMAKE_CURRENT_LIST_DIR}/../..")
build_and_run(shape_consumer shape_build)
