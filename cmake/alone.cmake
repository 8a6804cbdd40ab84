# Included by a project beside the library that is built alone: takes gonio from where it is installed (CMAKE_PREFIX_PATH).
# gonio_components names the parts that the project needs, gonio_optional_components those it uses if they are there.
find_package(gonio 0.2 REQUIRED CONFIG COMPONENTS ${gonio_components}
             OPTIONAL_COMPONENTS compiled image exr tiff exif scattered ${gonio_optional_components})
foreach(part IN ITEMS image exr tiff exif scattered shape)
  set(gonio_has_${part} ${gonio_${part}_FOUND})
endforeach()
include("${CMAKE_CURRENT_LIST_DIR}/project.cmake")
list(APPEND CMAKE_MODULE_PATH "${CMAKE_CURRENT_LIST_DIR}")
# What a project installs belongs to the package that it was built with.
include(GNUInstallDirs)
set(gonio_package_dir "${CMAKE_INSTALL_DATADIR}/cmake/gonio")
if(gonio_compiled_FOUND)
  set(gonio_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/gonio")
endif()
gonio_add_executables()
enable_testing()
