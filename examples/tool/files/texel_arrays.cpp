#include "texel_arrays.hpp"

#include <gonio/io/bytes/file.hpp>
#include <gonio/io/bytes/npy.hpp>

#include <cstdint>
#include <span>
#include <string>

namespace cli {

void write_texel_array(const std::filesystem::path& path, const gonio::io::svbrdf_header& header, std::string_view type,
                       const std::vector<std::size_t>& extents,
                       const std::function<void(gonio::io::file_writer&, Eigen::Index)>& write) {
  std::vector<std::size_t> shape{static_cast<std::size_t>(header.rows), static_cast<std::size_t>(header.columns)};
  shape.insert(shape.end(), extents.begin(), extents.end());
  const std::string start = gonio::io::npy_header(type, gonio::io::npy_shape_text(shape));
  gonio::io::write_atomically(path, [&](gonio::io::file_writer& file) {
    file.write(std::as_bytes(std::span(start)));
    for (Eigen::Index band = 0; band < header.bands(); ++band) write(file, band);
  });
}

void write_texel_array(const std::filesystem::path& path, const gonio::io::svbrdf_map& map,
                       std::vector<std::uint16_t> gonio::io::svbrdf_band::*part,
                       const std::vector<std::size_t>& extents) {
  write_texel_array(path, map.header(), "<f2", extents, [&](gonio::io::file_writer& file, Eigen::Index number) {
    const gonio::io::svbrdf_band band = map.read_band(number);
    file.write(std::as_bytes(std::span(band.*part)));
  });
}

}  // namespace cli
