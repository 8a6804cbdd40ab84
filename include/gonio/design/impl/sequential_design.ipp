#pragma once
/// Bodies of design/sequential_design.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/design/sequential_design.hpp>
#include <gonio/solve/product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gonio::design::detail {

/// Returns S P for the slopes S and the covariance P. The bytes do not depend on the number of threads.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd seen_covariance(const Eigen::MatrixXd& covariance, const sensitivity& seen,
                                                           thread_count threads) {
  Eigen::MatrixXd with(seen.slopes.rows(), covariance.cols());
  for_each_block(
      covariance.cols(), 128,
      [&](block range) {
        const Eigen::Index columns = range.end - range.begin;
        with.middleCols(range.begin, columns) = product(seen.slopes, covariance.middleCols(range.begin, columns));
      },
      threads);
  return with;
}

/// Returns the variance of each observed point, summed over the channels.
[[nodiscard]] GONIO_INLINE Eigen::VectorXd seen_variances(const Eigen::MatrixXd& with, const sensitivity& seen) {
  Eigen::VectorXd variances(seen.weights.size());
  for (Eigen::Index point = 0; point < variances.size(); ++point)
    variances[point] = with.middleRows(3 * point, 3).cwiseProduct(seen.slopes.middleRows(3 * point, 3)).sum();
  return variances;
}

}  // namespace gonio::design::detail

namespace gonio::design {

GONIO_INLINE double seen_deviation(const Eigen::MatrixXd& covariance, const sensitivity& seen, thread_count threads) {
  const Eigen::MatrixXd with = detail::seen_covariance(covariance, seen, threads);
  return seen.weights.dot(detail::seen_variances(with, seen).cwiseMax(0.0).cwiseSqrt());
}

GONIO_INLINE std::vector<double> seen_deviation_with_each(const Eigen::MatrixXd& covariance, const sensitivity& seen,
                                                          const Eigen::VectorXd& error_variances,
                                                          thread_count threads) {
  const Eigen::MatrixXd with = detail::seen_covariance(covariance, seen, threads);
  const Eigen::VectorXd before = detail::seen_variances(with, seen);
  std::vector<double> deviations(covariance.cols());
  for_each_index(
      covariance.cols(), 64,
      [&](Eigen::Index candidate) {
        const double variance = covariance(candidate, candidate) + error_variances[candidate];
        double sum = 0.0;
        for (Eigen::Index point = 0; point < before.size(); ++point) {
          const double explained = with.col(candidate).segment<3>(3 * point).squaredNorm() / variance;
          sum += seen.weights[point] * std::sqrt(std::max(before[point] - explained, 0.0));
        }
        deviations[candidate] = sum;
      },
      threads);
  return deviations;
}

GONIO_INLINE valid_cells default_candidates() { return valid_cells(grid({24, 15, 12}, cell_anchor::centre)); }

GONIO_INLINE void candidate_posterior::add(Eigen::Index candidate, double error_variance) {
  const Eigen::VectorXd with = covariance.col(candidate);
  covariance.noalias() -= with * (with / (with[candidate] + error_variance)).transpose();
}

}  // namespace gonio::design
