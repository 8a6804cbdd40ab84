# Nanoflann::Nanoflann: nanoflann.hpp, which Debian's libnanoflann-dev ships without a CMake package.
find_path(Nanoflann_INCLUDE_DIR nanoflann.hpp)
mark_as_advanced(Nanoflann_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Nanoflann REQUIRED_VARS Nanoflann_INCLUDE_DIR)

if(Nanoflann_FOUND AND NOT TARGET Nanoflann::Nanoflann)
  add_library(Nanoflann::Nanoflann INTERFACE IMPORTED)
  set_target_properties(Nanoflann::Nanoflann PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${Nanoflann_INCLUDE_DIR}")
endif()
