#pragma once
/// Measured materials of NVIDIA's Material Definition Language (`.mbsdf`): MDL specification 1.10.2, appendix B. A text
/// header, then binary blocks: reflection, transmission, or both. A block has a uint32 type (0: one channel, 1: red,
/// green and blue), a uint32 number of cells of theta from 0 to pi/2, another of phi from 0 to pi, and float32 values,
/// theta_in slowest, then theta_out, then phi; all little-endian.
///
/// A value is the BRDF, in sr^-1 and linear Rec. 709. Renderers average the values of both orders of the directions and
/// multiply by the cosine of the light's angle.

#include <gonio/core/brdf.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/model/polar_grid_brdf.hpp>

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

/// Keys and values in the header.
using mbsdf_metadata = std::map<std::string, std::string>;

/// A material and the header of its file.
struct mbsdf_material {
  model::polar_grid_brdf reflection;
  mbsdf_metadata metadata;
  bool has_transmission = false;  ///< the file's transmission is skipped, and is not written
};

/// Reads a material from the bytes of a file. Skips header lines that are not a key and a value, as MDL's own reader
/// does. Throws gonio::error for a file without reflection and for values that are not finite. Errors call the file
/// `name`.
[[nodiscard]] mbsdf_material read_mbsdf(std::span<const std::byte> bytes, const std::string& name);

/// Reads a file.
[[nodiscard]] inline mbsdf_material read_mbsdf(const std::filesystem::path& path) {
  return read_mbsdf(read_bytes(path), path.string());
}

/// Returns the bytes of a file. Characters of metadata that are not printable ASCII become '?', except line feeds.
/// Throws gonio::error for a key that is not letters, digits and underscores.
[[nodiscard]] std::vector<std::byte> write_mbsdf(const mbsdf_material& material);

/// Writes a file beside its target and renames it.
inline void write_mbsdf(const std::filesystem::path& path, const mbsdf_material& material) {
  write_atomically(path, write_mbsdf(material));
}

/// Tabulates any BRDF over a grid and writes it.
template <brdf Brdf>
void write_mbsdf(const std::filesystem::path& path, const Brdf& f, const model::polar_grid& grid = {},
                 const mbsdf_metadata& metadata = {}) {
  write_mbsdf(path, mbsdf_material{model::tabulate_polar(f, grid), metadata});
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/mbsdf.ipp>
#endif
