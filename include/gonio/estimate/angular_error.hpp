#pragma once
/// The penalty for measurements whose light and viewer directions have an angular error.

#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <array>
#include <numbers>
#include <vector>

namespace gonio {

namespace detail {

/// Returns eight pairs in which either the light or the viewer is turned by an angle in one of four directions.
[[nodiscard]] std::array<direction_pair, 8> misplaced_pairs(const direction_pair& meant, double angle);

}  // namespace detail

/// Returns the penalty to add to the prior's eta for a measurement whose light and viewer are each off by an angle in
/// radians, in unknown directions. It is m times the variance of the error of the mapped value, taken over the m
/// observations of the basis and over the directions of the error.
///
/// A value measured at x' but assigned to x is wrong by (q(x') - q(x)) . c + o. Here o is the error of the mean
/// material: its value at x', mapped as if it were at x. The weights c have orthonormal columns over the observations,
/// so m times the mean square is |q(x') - q(x)|^2 + m o^2. Light and viewer move independently: their errors add. O(k).
template <error_metric Metric>
[[nodiscard]] double angular_error_penalty(const pca<Metric>& basis, const direction_pair& meant, double angle) {
  const location here = locate(basis.cells(), to_half_difference(meant.wi, meant.wo));
  const Eigen::RowVectorXd row = row_at(basis, here);
  const double mean = offset_at(basis, here), m = static_cast<double>(basis.coefficients().rows());
  double sum = 0.0;
  for (const direction_pair& pair : detail::misplaced_pairs(meant, angle)) {
    const location there = locate(basis.cells(), to_half_difference(pair.wi, pair.wo));
    const double reflectance = basis.metric().inverse(offset_at(basis, there), there);
    const double wrong = basis.metric().forward(reflectance, here) - mean;
    sum += (row_at(basis, there) - row).squaredNorm() + m * wrong * wrong;
  }
  return sum / 4.0;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/angular_error.ipp>
#endif
