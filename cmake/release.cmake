# cmake -P cmake/release.cmake: compiles the whole tool as one static, stripped program for Linux, which contains the
# shipped files (GONIO_EMBED_DATA), into build/release. Then runs README's main job in a root that contains only the
# program, and packs the program with all licences.
#
# Debian has no static OpenEXR, and its libtiff.a needs JBIG-KIT, whose licence is the GPL. These and Imath are compiled
# here from Debian's source packages.
include("${CMAKE_CURRENT_LIST_DIR}/steps.cmake")
gonio_set_up(${gonio_library_packages} ${gonio_shape_packages} libexif-dev libtiff-dev dpkg-dev file)

set(folder "${source}/build/release")
set(libraries "${folder}/libraries")
file(STRINGS "${source}/CMakeLists.txt" project REGEX "^project\\(")
string(REGEX MATCH "[0-9]+\\.[0-9]+\\.[0-9]+" version "${project}")
cmake_host_system_information(RESULT machine QUERY OS_PLATFORM)
set(name "gonio-${version}-linux-${machine}")

# ---- libraries ------------------------------------------------------------------------------------------------------

# gonio_fetch_sources(PACKAGE...): downloads and unpacks Debian's sources with their patches, from this machine's
# archive.
function(gonio_fetch_sources)
  file(GLOB list /etc/apt/sources.list.d/debian.sources)
  if(NOT list)
    message(FATAL_ERROR "/etc/apt/sources.list.d/debian.sources does not say where Debian's sources of ${ARGN} are")
  endif()
  file(READ "${list}" text)
  string(REGEX REPLACE "(^|\n)Types:[^\n]*" "\\1Types: deb-src" text "${text}")
  file(WRITE "${folder}/apt/debian.sources" "${text}")
  file(MAKE_DIRECTORY "${folder}/apt/lists/partial")
  set(apt_get apt-get -qq -o Dir::Etc::sourcelist=${folder}/apt/debian.sources -o Dir::Etc::sourceparts=-
      -o Dir::State::lists=${folder}/apt/lists -o APT::Sandbox::User=)
  step("list of sources" ${apt_get} update)
  step("sources of ${ARGN}" ${cmake} -E chdir "${folder}" ${apt_get} source ${ARGN})
endfunction()

# gonio_build_static(PACKAGE ARGUMENT...): compiles a source package as a static library.
function(gonio_build_static package)
  file(GLOB from "${folder}/${package}-[0-9]*")
  step("${package}: configure" ${cmake} -S "${from}" -B "${folder}/${package}" -G Ninja -D CMAKE_BUILD_TYPE=Release
       -D BUILD_SHARED_LIBS=OFF -D BUILD_TESTING=OFF -D CMAKE_PREFIX_PATH=${libraries}
       -D CMAKE_INSTALL_PREFIX=${libraries} -D CMAKE_INSTALL_LIBDIR=lib ${ARGN})
  step("${package}: build" ${cmake} --build "${folder}/${package}" --parallel ${cores} --target install)
endfunction()

# A second release uses the libraries of the first.
if(NOT EXISTS "${libraries}/lib/libtiff.a")
  file(REMOVE_RECURSE "${folder}")
  gonio_fetch_sources(imath openexr tiff)
  gonio_build_static(imath)
  gonio_build_static(openexr -D OPENEXR_BUILD_TOOLS=OFF -D OPENEXR_INSTALL_EXAMPLES=OFF)
  gonio_build_static(tiff -D jbig=OFF -D tiff-tools=OFF -D tiff-tests=OFF -D tiff-contrib=OFF -D tiff-docs=OFF)
endif()

# ---- the tool -------------------------------------------------------------------------------------------------------

# Finds static libraries only. Debian's dlib names shared libraries, which the tool does not need.
file(WRITE "${folder}/static.cmake" [=[
set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
file(WRITE "${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/dlib-config.cmake" "
  find_library(dlib_LIBRARY dlib REQUIRED)
  add_library(dlib::dlib INTERFACE IMPORTED)
  target_link_libraries(dlib::dlib INTERFACE \${dlib_LIBRARY})")
]=])
step("configure" ${cmake} -S . -B "${folder}/build" -G Ninja -D CMAKE_BUILD_TYPE=Release
     -D GONIO_BUILD_TESTS=OFF -D GONIO_BUILD_BENCH=OFF -D GONIO_BUILD_SHAPE=ON -D GONIO_EMBED_DATA=ON
     -D CMAKE_PROJECT_INCLUDE=${folder}/static.cmake -D CMAKE_PREFIX_PATH=${libraries}
     "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG -ffunction-sections -fdata-sections"
     "-DCMAKE_EXE_LINKER_FLAGS=-static -s -Wl,--gc-sections"
     "-DCMAKE_CXX_STANDARD_LIBRARIES=-lwebp -lzstd -llzma -lLerc -ljpeg -ldeflate -lz")
step("build" ${cmake} --build "${folder}/build" --parallel ${cores} --target gonio_tool)

# ---- README's main job in an empty root -----------------------------------------------------------------------------

# Without root rights, change the root within a user namespace.
execute_process(COMMAND id -u OUTPUT_VARIABLE user OUTPUT_STRIP_TRAILING_WHITESPACE)
set(root "${folder}/root")
set(enter unshare --root=${root} --wd=/)
if(NOT user STREQUAL "0")
  list(INSERT enter 1 --map-root-user)
endif()
file(REMOVE_RECURSE "${root}")
file(MAKE_DIRECTORY "${root}")
file(COPY "${folder}/build/bin/gonio" DESTINATION "${root}")
execute_process(COMMAND file --brief "${root}/gonio" OUTPUT_VARIABLE kind COMMAND_ERROR_IS_FATAL ANY)
if(NOT kind MATCHES "statically linked, .*stripped" OR kind MATCHES "not stripped")
  message(FATAL_ERROR "gonio is not a stripped static program: ${kind}")
endif()

# run(LINE FILE): runs a command line of the tool. The file must not be empty afterwards.
function(run line file)
  separate_arguments(arguments UNIX_COMMAND "${line}")
  step("gonio ${line}" ${enter} /gonio ${arguments})
  file(SIZE "${root}/${file}" size)
  if(size EQUAL 0)
    message(FATAL_ERROR "gonio ${line}: ${file} is empty")
  endif()
endfunction()
run("expand --formula red-paint -o truth.binary" truth.binary)
run("sample truth.binary --directions shipped:directions/point-20-expected-error.csv -o samples.csv" samples.csv)
run("reconstruct samples.csv -o estimate.binary" estimate.binary)
run("report samples.csv -o report.html" report.html)
run("render estimate.binary truth.binary --size 256 -o spheres.png" spheres.png)
run("design --apparatus three-axis-goniometer -n 2 -o two.csv" two.csv)
run("info shipped:materials.prior" gonio)

set(starts 20)
string(TIMESTAMP begin "%s%f")
foreach(start RANGE 1 ${starts})
  execute_process(COMMAND "${root}/gonio" --version OUTPUT_VARIABLE shown COMMAND_ERROR_IS_FATAL ANY)
endforeach()
string(TIMESTAMP end "%s%f")
math(EXPR milliseconds "(${end} - ${begin}) / ${starts} / 1000")

# ---- the archive ----------------------------------------------------------------------------------------------------

# The licences of all libraries in the program. Those of libexif and the C library require their sources to be offered.
file(REMOVE_RECURSE "${folder}/${name}")
file(MAKE_DIRECTORY "${folder}/${name}/licences")
file(COPY "${root}/gonio" "${source}/LICENSE" DESTINATION "${folder}/${name}")
foreach(package IN ITEMS libc6 gcc-12-base zlib1g libstb-dev libexif-dev libtiff-dev libopenexr-dev libimath-dev
                         libwebp-dev libzstd-dev liblzma-dev liblerc-dev libjpeg62-turbo-dev libdeflate-dev
                         libeigen3-dev libxtensor-dev xtl-dev libcli11-dev nlohmann-json3-dev libdlib-dev
                         libnanoflann-dev)
  file(COPY_FILE "/usr/share/doc/${package}/copyright" "${folder}/${name}/licences/${package}")
endforeach()
execute_process(COMMAND "${cmake}" -E tar czf "${name}.tar.gz" "${name}" WORKING_DIRECTORY "${folder}"
                COMMAND_ERROR_IS_FATAL ANY)
file(SIZE "${root}/gonio" size)
file(SIZE "${folder}/${name}.tar.gz" packed)
file(SHA256 "${folder}/${name}.tar.gz" checksum)
message("${shown}${folder}/${name}.tar.gz: ${packed} bytes, the program in it ${size} bytes; it starts in"
        " ${milliseconds} ms (mean of ${starts})\nsha256 ${checksum}")
