#pragma once
/// Files of UTIA's BRDF database (`.bin`; btf.utia.cas.cz): anisotropic materials. J. Filip and R. Vavra,
/// "Template-Based Sampling of Anisotropic BRDFs", Computer Graphics Forum 33(7), 2014 (doi:10.1111/cgf.12477).
///
/// A file has no header: three planes (red, green, blue) of little-endian numbers, float64 or float32, for each
/// theta_i, phi_i, theta_o and phi_o; phi_o varies fastest. By default polar angles are 0, 15, ... 75 degrees and
/// azimuths 0, 7.5, ... 352.5 degrees: 288 x 288 numbers a plane.

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/model/angle_grid_brdf.hpp>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

/// The directions of a file, of light and viewer alike.
struct utia_directions {
  Eigen::Index polar = 6;      ///< number of polar angles
  double polar_step = 15.0;    ///< degrees
  Eigen::Index azimuths = 48;  ///< number of azimuths, over a full turn

  /// Returns the number of pairs of directions.
  [[nodiscard]] Eigen::Index size() const noexcept { return polar * azimuths * polar * azimuths; }
};

/// Reads a material from the bytes of a file. Errors call the file `name`. Values are linear in each angle. Above the
/// last polar angle, they continue the line through the last two, as in the database's own program. Throws gonio::error
/// if the size does not match the directions, and for values that are not finite.
[[nodiscard]] model::angle_grid_brdf read_utia(std::span<const std::byte> bytes, const std::string& name,
                                               const utia_directions& directions = {});

/// Reads a file.
[[nodiscard]] inline model::angle_grid_brdf read_utia(const std::filesystem::path& path,
                                                      const utia_directions& directions = {}) {
  return read_utia(read_bytes(path), path.string(), directions);
}

/// Returns a grid of these directions without values.
[[nodiscard]] model::angle_grid utia_grid(const utia_directions& directions = {});

/// Returns the bytes of a file of float64 numbers. Throws gonio::error for a grid of other directions.
[[nodiscard]] std::vector<std::byte> write_utia(const model::angle_grid& grid, const utia_directions& directions = {});

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/utia.ipp>
#endif
