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

/// Returns eight pairs in which either the light or the viewer is turned by `angle` radians in one of four directions.
[[nodiscard]] std::array<direction_pair, 8> pairs_with_angular_error(const direction_pair& meant, double angle);

}  // namespace detail

/// Returns the penalty to add to the prior's eta for a measurement whose light and viewer are each off by an angle in
/// radians, in unknown directions. The penalty is m times the mean square error of the mapped value, where the mean is
/// over the m observations of the basis and over the directions of the error.
///
/// A value measured at x' but assigned to x is wrong by (q(x') - q(x)) . c + o. Here q are the k components, c the
/// weights of an observation, and o the error of the mean material: the material's value at x', mapped as if measured
/// at x, minus the material's mapped value at x. The columns of the m x k weights are orthonormal, so m times the mean
/// square is |q(x') - q(x)|^2 + m o^2. The errors of light and viewer are independent: their penalties add. O(k).
template <error_metric Metric>
[[nodiscard]] double angular_error_penalty(const pca<Metric>& basis, const direction_pair& meant, double angle) {
  const location here = locate(basis.cells(), to_half_difference(meant.wi, meant.wo));
  const Eigen::RowVectorXd row = row_at(basis, here);
  const double mean = offset_at(basis, here), m = basis.observations();
  double sum = 0.0;
  for (const direction_pair& pair : detail::pairs_with_angular_error(meant, angle)) {
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
