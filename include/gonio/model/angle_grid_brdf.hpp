#pragma once
/// Materials on a grid of four angles, two of the light and two of the viewer, as instruments and databases tabulate
/// anisotropic reflectance: UTIA's database (io/materials/utia.hpp) and Zemax's tables
/// (io/measurements/zemax_table.hpp).

#include <gonio/core/brdf.hpp>

#include <Eigen/Core>

#include <array>
#include <memory>
#include <vector>

namespace gonio::model {

/// The meaning of the viewer's two angles in a grid.
enum class viewer_angles {
  polar,          ///< polar angle and azimuth of the viewer, as of the light
  about_specular  ///< angle to the specular direction, and azimuth about it (io/measurements/zemax_bsdf.hpp)
};

/// The values outside the outermost polar angles.
enum class beyond_grid {
  constant,     ///< as at the outermost
  extrapolated  ///< on a straight line through the last two
};

/// The angles of a grid's nodes, in radians, ascending, and the values at its nodes.
struct angle_grid {
  std::vector<double> phi_i;           ///< azimuths of the light, within a full turn; a single one: isotropic
  std::vector<double> theta_i;         ///< polar angles of the light
  std::vector<double> viewer_azimuth;  ///< within a full turn, or from 0 to pi: the other side mirrors them
  std::vector<double> viewer_polar;    ///< polar or radial angles of the viewer
  std::vector<float> values;  ///< sr^-1: red, green and blue of a node; viewer_polar varies fastest, phi_i slowest
  viewer_angles viewer = viewer_angles::polar;
  beyond_grid beyond = beyond_grid::constant;

  /// Returns the number of nodes.
  [[nodiscard]] Eigen::Index size() const noexcept {
    return std::ssize(phi_i) * std::ssize(theta_i) * std::ssize(viewer_azimuth) * std::ssize(viewer_polar);
  }
};

/// Returns the directions of a node, from 0; the viewer may be below the horizon.
[[nodiscard]] direction_pair directions_of(const angle_grid& grid, Eigen::Index node) noexcept;

namespace detail {

/// Returns the direction at a radial angle and an azimuth about the specular direction of light at (theta, phi).
[[nodiscard]] direction direction_about_specular(double theta, double phi, double radial, double azimuth) noexcept;

/// Two neighbours on an axis, and the weight of each.
struct axis_neighbours {
  Eigen::Index first = 0, second = 0;
  double weight_of_first = 1.0, weight_of_second = 0.0;
};

/// Ascending angles in radians. Angles outside them are clamped or extrapolated, unless the axis is an azimuth.
class angle_axis {
 public:
  enum class kind { clamped, extrapolated, full_turn, half_turn };

  angle_axis(const std::vector<double>& nodes, kind of);

  [[nodiscard]] axis_neighbours find(double angle) const noexcept;

 private:
  std::vector<double> nodes_;
  kind kind_;
};

}  // namespace detail

/// The BRDF of a grid, linear in each angle between the nodes. A value type; copies share the values.
///
/// A table about the specular direction has nodes below the horizon. They get the value of the last node above it, so
/// that values just above the horizon do not fade.
///
/// Measurements are not reciprocal. The `brdf` concept requires reciprocity, so the value is the mean of both orders of
/// the directions. `as_measured` returns a single order.
class angle_grid_brdf {
 public:
  /// Throws gonio::error unless all angles ascend and are possible, the number of values matches and all are finite.
  explicit angle_grid_brdf(angle_grid grid);

  [[nodiscard]] const angle_grid& grid() const noexcept;
  [[nodiscard]] bool is_anisotropic() const noexcept { return grid().phi_i.size() > 1; }

  /// Returns zero below the horizon. O(log n).
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    return 0.5 * (as_measured(wi, wo) + as_measured(wo, wi));
  }

  /// Returns the value with the light at `wi` and the viewer at `wo`.
  [[nodiscard]] rgb as_measured(const direction& wi, const direction& wo) const noexcept;

 private:
  struct stored;

  std::shared_ptr<const stored> stored_;
};

static_assert(brdf<angle_grid_brdf>);

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/angle_grid_brdf.ipp>
#endif
