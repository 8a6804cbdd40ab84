#pragma once
/// Bodies of estimate/correction_iteration.hpp.

#include <gonio/basis/correction.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/estimate/correction_iteration.hpp>
#include <gonio/solve/float_product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gonio::detail {

GONIO_INLINE correction_round describe_round(const channel_values& inlier_weights, const channel_values& weights,
                                             const channel_values& wanted, const channel_values& found) {
  const double total = weights.cast<double>().sum();
  const double squares = (weights.cast<double>() * (wanted.cast<double>() - 1.0).square()).sum();
  return {total > 0.0 ? std::sqrt(squares / total) : 0.0, (found - 1.0f).abs().cast<double>().mean(),
          (inlier_weights < 0.5f).cast<double>().mean()};
}

GONIO_INLINE brdf_table total_correction(const correction& corrections, const std::vector<Eigen::MatrixXd>& weights,
                                         thread_count threads) {
  brdf_table total(corrections.cells());
  const Eigen::Index functions = corrections.size();
  for (Eigen::Index c = 0; c < 3; ++c) {
    Eigen::MatrixXf betas(std::ssize(weights), functions);
    for (Eigen::Index round = 0; round < std::ssize(weights); ++round)
      betas.row(round) = weights[round].col(c).cast<float>();
    const auto channel = corrections.channel(c);
    for_each_block(
        corrections.cells().size(), 1024,
        [&](block range) {
          const Eigen::Index begin = range.begin, count = range.size();
          const Eigen::MatrixXf sigmas = product(betas, channel.values().middleRows(begin, count).transpose());
          for (Eigen::Index i = 0; i < count; ++i) {
            float factor = 1.0f;
            for (Eigen::Index round = 0; round < sigmas.rows(); ++round)
              factor = std::min(factor * sigmas(round, i), correction_factor::largest_factor);
            total.values()[3 * (range.begin + i) + c] = factor;
          }
        },
        threads);
  }
  return total;
}

}  // namespace gonio::detail
