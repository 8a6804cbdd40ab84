# An overlay port of this checkout: vcpkg install gonio --overlay-ports=cmake/vcpkg. It has only headers, so no debug
# build.
set(VCPKG_BUILD_TYPE release)
cmake_path(SET checkout NORMALIZE "${CURRENT_PORT_DIR}/../..")
vcpkg_cmake_configure(
  SOURCE_PATH "${checkout}"
  OPTIONS -DGONIO_BUILD_COMPILED=OFF -DGONIO_BUILD_TESTS=OFF -DGONIO_BUILD_EXAMPLES=OFF -DGONIO_BUILD_BENCH=OFF
          -DGONIO_PARTS=)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH share/cmake/gonio)
# vcpkg expects .pc files of packages with libraries in lib/, and this package needs zlib.
file(MAKE_DIRECTORY "${CURRENT_PACKAGES_DIR}/lib")
file(RENAME "${CURRENT_PACKAGES_DIR}/share/pkgconfig" "${CURRENT_PACKAGES_DIR}/lib/pkgconfig")
vcpkg_fixup_pkgconfig()
vcpkg_install_copyright(FILE_LIST "${checkout}/LICENSE")
