#pragma once
/// Options for the interpolation of scattered measurements: the distance, the number of neighbours and their weights.
/// Used by interpolate/scattered_brdf.hpp.

#include <gonio/core/direction.hpp>

#include <Eigen/Core>

#include <array>

namespace gonio {

/// Embeds pairs of directions in a space of four dimensions, where the distance of two points measures how much the
/// pairs differ.
///
/// With s = sqrt(theta_h / (pi / 2)) and t = theta_d / (pi / 2) the coordinates are
/// (s, a t, b r cos 2 phi_d, b r sin 2 phi_d), where r = sin theta_h sin theta_d:
/// - the root resolves highlights, as MERL's grid does;
/// - 2 phi_d: by reciprocity phi_d and phi_d + pi are the same pair;
/// - r: at theta_d = 0 there is no phi_d; at theta_h = 0 phi_d only rotates both directions about the normal, which has
///   no effect on an isotropic material. r cos phi_d is half the difference of the cosines of light and viewer.
/// Two pairs have distance zero exactly if every reciprocal isotropic material has the same value for both. Mirror
/// symmetry (phi_d equivalent to -phi_d) is not assumed.
struct pair_embedding {
  double theta_d_scale = 1.0;  ///< a
  double phi_d_scale = 0.25;   ///< b

  [[nodiscard]] std::array<double, 4> operator()(const half_difference& angles) const noexcept;
};

/// The quantity that is averaged over neighbours.
enum class interpolation_domain {
  reflectance,
  logarithm,  ///< ln(rho + 0.001 sr^-1), with negative values as zero: `log_relative` with a black reference
};

/// The defaults are the best on measured materials, cross-validated between materials: docs/results/scattered.md.
struct scattered_options {
  static constexpr Eigen::Index most_neighbours = 64;

  Eigen::Index neighbours = 16;  ///< k, from 1 (the nearest alone) to `most_neighbours`
  double exponent = 1.5;         ///< p, above 0
  pair_embedding embedding = {};
  interpolation_domain domain = interpolation_domain::logarithm;
};

/// Throws gonio::error naming the first option outside of its range.
void require_usable(const scattered_options& options);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/interpolate/impl/scattered_options.ipp>
#endif
