# Installs headers, data, and the package gonio for CMake and pkg-config.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
# Headers suit any machine, a compiled library only one.
set(gonio_package_dir "${CMAKE_INSTALL_DATADIR}/cmake/gonio")
set(gonio_any_machine ARCH_INDEPENDENT)
if(TARGET gonio_compiled)
  set(gonio_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/gonio")
  set(gonio_any_machine)
endif()

install(DIRECTORY include/ TYPE INCLUDE FILES_MATCHING PATTERN "*.hpp" PATTERN "*.ipp")
install(FILES examples/data/materials.prior DESTINATION "${CMAKE_INSTALL_DATADIR}/gonio" OPTIONAL)
install(DIRECTORY examples/data/directions examples/data/apparatus DESTINATION "${CMAKE_INSTALL_DATADIR}/gonio")
install(FILES LICENSE TYPE DOC)

# gonio_add_pkg_config(NAME FOLDER): installs NAME.pc, for builds without CMake. Its prefix is relative to the file: an
# installation may be moved.
function(gonio_add_pkg_config name folder)
  file(RELATIVE_PATH prefix "/${folder}/pkgconfig" "/")
  set(prefix "\${pcfiledir}/${prefix}")
  configure_file("${PROJECT_SOURCE_DIR}/cmake/${name}.pc.in" ${name}.pc @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/${name}.pc" DESTINATION "${folder}/pkgconfig")
endfunction()
gonio_add_pkg_config(gonio "${CMAKE_INSTALL_DATADIR}")
if(TARGET gonio_compiled)
  gonio_add_pkg_config(gonio-compiled "${CMAKE_INSTALL_LIBDIR}")
endif()

# Each target has its own export set: a user without the libraries of one target can use the others.
install(TARGETS gonio_render EXPORT gonioRenderTargets INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
set(gonio_exports gonioRenderTargets)
if(TARGET gonio)
  install(TARGETS gonio EXPORT gonioTargets)
  list(APPEND gonio_exports gonioTargets)
endif()
if(TARGET gonio_compiled)
  install(TARGETS gonio_compiled EXPORT gonioCompiledTargets)
  list(APPEND gonio_exports gonioCompiledTargets)
endif()
foreach(export IN LISTS gonio_exports)
  install(EXPORT ${export} NAMESPACE gonio:: DESTINATION "${gonio_package_dir}")
endforeach()
foreach(part IN LISTS gonio_parts)
  gonio_install_part(${part})
endforeach()

configure_package_config_file(cmake/gonioConfig.cmake.in "${PROJECT_BINARY_DIR}/gonioConfig.cmake"
  INSTALL_DESTINATION "${gonio_package_dir}"
  PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/gonioConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion ${gonio_any_machine})
install(FILES
  "${PROJECT_BINARY_DIR}/gonioConfig.cmake"
  "${PROJECT_BINARY_DIR}/gonioConfigVersion.cmake"
  cmake/FindExif.cmake
  cmake/FindNanoflann.cmake
  cmake/FindStb.cmake
  DESTINATION "${gonio_package_dir}")
