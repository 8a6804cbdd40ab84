# An overlay port of this checkout: vcpkg install gonio --overlay-ports=cmake/vcpkg. The headers alone, so that there is
# nothing to debug.
set(VCPKG_BUILD_TYPE release)
cmake_path(SET checkout NORMALIZE "${CURRENT_PORT_DIR}/../..")
vcpkg_cmake_configure(
  SOURCE_PATH "${checkout}"
  OPTIONS -DGONIO_BUILD_COMPILED=OFF -DGONIO_BUILD_TESTS=OFF -DGONIO_BUILD_EXAMPLES=OFF -DGONIO_BUILD_BENCH=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH share/cmake/gonio)
vcpkg_fixup_pkgconfig()
vcpkg_install_copyright(FILE_LIST "${checkout}/LICENSE")
