#pragma once
/// Zemax's tabular BSDF format (io/measurements/zemax_bsdf.hpp) as complete materials: read as a grid that can be
/// evaluated, and written from any BRDF. Rotations of the sample are azimuths of the light, so an anisotropic material
/// keeps its axes.

#include <gonio/core/brdf.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/model/angle_grid_brdf.hpp>

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Reads the text of a file. Errors call the file `name`. Throws gonio::error like `read_zemax_bsdf`, and for angles
/// that do not ascend.
[[nodiscard]] model::angle_grid_brdf read_zemax_table(std::string_view text, const std::string& name);

/// Reads a file.
[[nodiscard]] model::angle_grid_brdf read_zemax_table(const std::filesystem::path& path);

/// The angles of a written file: radial angles up to 175 degrees, denser towards the specular direction.
struct zemax_resolution {
  Eigen::Index rotations = 24;   ///< of the sample, uniform over a full turn; 1 for an isotropic material
  Eigen::Index incidences = 18;  ///< from 0 to 85 degrees
  Eigen::Index azimuths = 24;    ///< about the specular direction, uniform over a full turn (half as many plus one,
                                 ///< from 0 to 180 degrees, for an isotropic material)
  Eigen::Index radials = 36;
};

/// Returns a grid of these angles without values. Throws gonio::error for fewer than 1 rotation or 2 of another angle,
/// and for more than 360.
[[nodiscard]] model::angle_grid zemax_grid(const zemax_resolution& resolution);

/// Returns the text of a file in CIE XYZ: `ASymmetrical4D` with rotations, otherwise `PlaneSymmetrical`. Nodes below
/// the horizon are 0. Throws gonio::error for a grid that is not about the specular direction.
[[nodiscard]] std::string write_zemax_table(const model::angle_grid& grid, const std::string& comment = "gonio");

/// Tabulates a BRDF. If there is one rotation, averages both sides of the plane of incidence. The values do not depend
/// on the number of threads.
template <brdf Brdf>
[[nodiscard]] model::angle_grid tabulate_about_specular(const Brdf& f, const zemax_resolution& resolution = {},
                                                        thread_count threads = {}) {
  model::angle_grid grid = zemax_grid(resolution);
  grid.values.resize(3 * grid.size());
  for_each_index(
      grid.size(), 1024,
      [&](Eigen::Index node) {
        const auto [wi, wo] = model::directions_of(grid, node);
        if (!(wo.z() > 0.0)) return;
        rgb value = f(wi, wo);
        if (resolution.rotations == 1) value = 0.5 * (value + rgb(f(wi, direction(wo.x(), -wo.y(), wo.z()))));
        for (Eigen::Index c = 0; c < 3; ++c) grid.values[3 * node + c] = static_cast<float>(value[c]);
      },
      threads);
  return grid;
}

/// Writes a file beside its target and renames it.
void write_zemax_table(const std::filesystem::path& path, const model::angle_grid& grid,
                       const std::string& comment = "gonio");

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/zemax_table.ipp>
#endif
