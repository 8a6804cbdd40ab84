#pragma once
/// Measured materials in a parameterisation that follows each material's highlight, as in the RGL database. Dupuy and
/// Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", ACM Transactions on Graphics
/// 37(6), 2018 (doi:10.1145/3272127.3275059), section 4.
///
/// Let m be the half vector of wi and wo, D the distribution of microfacet normals and sigma the projected area. Then
///     f(wi, wo) = rgb(u; wi) D(m) / (4 sigma(wi) cos theta_o),
/// where u in [0, 1]^2 is m mapped by the cumulative distribution of the normals that are visible from wi. Tables are
/// over theta_i, and also over phi_i if the material is anisotropic.

#include <gonio/core/brdf.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <iterator>
#include <memory>
#include <vector>

namespace gonio::model {

/// `tables` tables of values on regular grids over [0, 1]^2. Each has `rows` x `columns` numbers, row by row; the
/// outermost nodes of a grid lie on the border of the square.
struct unit_square_tables {
  Eigen::Index tables = 0;
  Eigen::Index rows = 0;
  Eigen::Index columns = 0;
  std::vector<float> values;

  [[nodiscard]] const float* row(Eigen::Index table, Eigen::Index number) const noexcept {
    return values.data() + (table * rows + number) * columns;
  }
};

/// The tables of a material. A direction maps to [0, 1]^2: its azimuth, phi / 2 pi + 1/2, across the rows, and
/// sqrt(2 theta / pi) along them. If the material is isotropic, azimuths are relative to the azimuth of wi.
///
/// The azimuths of an anisotropic material cover a full turn, from -pi to pi or nearly so. If a turn by pi does not
/// change the material, they may cover half a turn, from -pi to 0. If the material also has a plane of symmetry, they
/// may cover a quarter turn, from -pi to -pi/2.
struct adaptive_brdf_parts {
  std::vector<double> theta_i;         ///< n polar angles of wi in radians, ascending from 0 to pi/2
  unit_square_tables normals;          ///< D: one table
  unit_square_tables projected_area;   ///< sigma: one table
  unit_square_tables visible_normals;  ///< density of visible normals: n p tables; their scales do not matter
  unit_square_tables reflectance;      ///< rgb: 3 n p tables; red, green and blue of the first wi come first
  std::vector<double> phi_i = {};      ///< p azimuths of wi in radians, ascending; empty (p = 1): isotropic. The tables
                                       ///< of the first azimuth, for all theta_i, come first

  [[nodiscard]] bool is_anisotropic() const noexcept { return !phi_i.empty(); }
  /// Returns the number of directions wi that have tables: n p.
  [[nodiscard]] Eigen::Index lights() const noexcept {
    return std::ssize(theta_i) * std::max<Eigen::Index>(std::ssize(phi_i), 1);
  }
};

/// A BRDF given by `adaptive_brdf_parts`. A value type; copies share the tables. Besides the parts, it stores the
/// numbers of the tables in the order of look-up: 6 MB of parts need 13 MB.
///
/// Measurements are not reciprocal: exchanging the directions changes the values of the RGL database by 6 to 15 % on
/// average. The `brdf` concept requires reciprocity, so the value is the mean of f(wi, wo) and f(wo, wi). `as_measured`
/// returns f(wi, wo).
class adaptive_brdf {
 public:
  /// Throws gonio::error unless the sizes match, every number is finite, densities and areas are not negative, every
  /// table of visible normals has a positive density, and the azimuths cover a full, a half or a quarter turn.
  explicit adaptive_brdf(adaptive_brdf_parts parts);

  [[nodiscard]] const adaptive_brdf_parts& parts() const noexcept;

  /// Returns true if the value depends on the azimuth of the light, not only on the difference of both azimuths.
  [[nodiscard]] bool is_anisotropic() const noexcept;

  /// Returns reflectance in sr^-1; zero below the horizon. O(log n) for n angles theta_i.
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept;

  /// Returns the value as measured, with the light at `wi` and the viewer at `wo`.
  [[nodiscard]] rgb as_measured(const direction& wi, const direction& wo) const noexcept;

 private:
  struct stored;  ///< the parts, and their numbers in the order of look-up

  std::shared_ptr<const stored> tables_;
};

static_assert(brdf<adaptive_brdf>);

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/adaptive_brdf.ipp>
#endif
