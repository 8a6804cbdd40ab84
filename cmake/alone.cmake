# Included by a project beside the library when it is built alone. Finds the installed gonio (CMAKE_PREFIX_PATH), with
# the parts in gonio_optional_components if they are installed.
find_package(gonio 0.2 REQUIRED CONFIG COMPONENTS image
             OPTIONAL_COMPONENTS compiled exr tiff exif scattered ${gonio_optional_components})
foreach(part IN ITEMS image exr tiff exif scattered)
  set(gonio_has_${part} ${gonio_${part}_FOUND})
endforeach()
include("${CMAKE_CURRENT_LIST_DIR}/project.cmake")
list(APPEND CMAKE_MODULE_PATH "${CMAKE_CURRENT_LIST_DIR}")
# A project installs its files into the package that it was built with.
include(GNUInstallDirs)
set(gonio_package_dir "${CMAKE_INSTALL_DATADIR}/cmake/gonio")
if(gonio_compiled_FOUND)
  set(gonio_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/gonio")
endif()
gonio_add_executables()
enable_testing()
# All of a project's targets share this one's precompiled header.
file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/precompiled.cpp" CONTENT "// Nothing but the precompiled header.\n")
add_library(gonio_precompiled OBJECT "${CMAKE_CURRENT_BINARY_DIR}/precompiled.cpp")
target_link_libraries(gonio_precompiled PRIVATE gonio_executables gonio_warnings gonio_native)
gonio_precompile(gonio_precompiled)
