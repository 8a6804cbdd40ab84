#pragma once
/// Arrays of a map's texels, written band by band.

#include <gonio/io/bytes/file.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace cli {

/// Writes an array (.npy) of rows x columns x `extents` with elements of a NumPy type. `write(file, number)` writes the
/// elements of band `number`.
void write_texel_array(const std::filesystem::path& path, const gonio::io::svbrdf_header& header, std::string_view type,
                       const std::vector<std::size_t>& extents,
                       const std::function<void(gonio::io::file_writer&, Eigen::Index)>& write);

/// Writes the member `part` of all bands as an array of half floats.
void write_texel_array(const std::filesystem::path& path, const gonio::io::svbrdf_map& map,
                       std::vector<std::uint16_t> gonio::io::svbrdf_band::*part,
                       const std::vector<std::size_t>& extents);

}  // namespace cli
