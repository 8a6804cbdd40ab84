#pragma once
/// Measured materials in a parameterisation that follows each material's highlight, as in the RGL database. Dupuy and
/// Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", ACM Transactions on Graphics
/// 37(6), 2018 (doi:10.1145/3272127.3275059), section 4.
///
/// Let m be the half vector of wi and wo, D the distribution of microfacet normals and sigma the projected area. Then
///     f(wi, wo) = rgb(u; theta_i) D(m) / (4 sigma(wi) cos theta_o),
/// where u in [0, 1]^2 is m mapped by the cumulative distribution of the normals that are visible from wi.

#include <gonio/core/brdf.hpp>

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace gonio::model {

/// Values on regular grids over [0, 1]^2 whose outermost nodes lie on the border: `tables` grids of `rows` x `columns`
/// numbers, row by row.
struct unit_square_tables {
  Eigen::Index tables = 0;
  Eigen::Index rows = 0;
  Eigen::Index columns = 0;
  std::vector<float> values;

  [[nodiscard]] const float* row(Eigen::Index table, Eigen::Index number) const noexcept {
    return values.data() + (table * rows + number) * columns;
  }
};

/// The tables of an isotropic material. A direction maps to [0, 1]^2: its azimuth, phi / 2 pi + 1/2, across the rows,
/// and sqrt(2 theta / pi) along them.
struct adaptive_brdf_parts {
  std::vector<double> theta_i;         ///< n polar angles of wi in radians, ascending from 0 to pi/2
  unit_square_tables normals;          ///< D: one table
  unit_square_tables projected_area;   ///< sigma: one table
  unit_square_tables visible_normals;  ///< density of visible normals: n tables; their scales do not matter
  unit_square_tables reflectance;      ///< rgb: 3 n tables; red, green and blue of the first theta_i come first
};

/// A BRDF given by such tables. A value type; copies share the tables. It also stores all numbers in the order of
/// look-up: 6 MB of parts need 13 MB.
///
/// Measurements are not reciprocal: exchanging the directions changes the values of the RGL database by 6 to 15 % on
/// average. The `brdf` concept requires reciprocity, so the value is the mean of both orders. `as_measured` returns a
/// single order.
class adaptive_brdf {
 public:
  /// Throws gonio::error unless the sizes match, every number is finite, densities and areas are not negative, and
  /// every table of visible normals has a positive density.
  explicit adaptive_brdf(adaptive_brdf_parts parts);

  [[nodiscard]] const adaptive_brdf_parts& parts() const noexcept;

  /// Returns reflectance in sr^-1; zero below the horizon. O(log n).
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept;

  /// Returns the value as measured, with the light at `wi` and the viewer at `wo`.
  [[nodiscard]] rgb as_measured(const direction& wi, const direction& wo) const noexcept;

 private:
  struct stored;  ///< the parts, and the same numbers in the order of look-up

  std::shared_ptr<const stored> tables_;
};

static_assert(brdf<adaptive_brdf>);

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/adaptive_brdf.ipp>
#endif
