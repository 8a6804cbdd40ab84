#pragma once
/// Bodies of robust/correction_iteration.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/robust/correction.hpp>
#include <gonio/robust/correction_iteration.hpp>
#include <gonio/solve/float_product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gonio::detail {

GONIO_INLINE correction_round describe_round(const channel_values& inlier_weights, const channel_values& weights,
                                             const channel_values& wanted, const channel_values& found,
                                             thread_count threads) {
  // Sum the weights, the weighted squares, the changes, and the samples with a weight below one half.
  const Eigen::Array4d sums = sum_over_blocks(
      weights.cols(), 4096, Eigen::Array4d(Eigen::Array4d::Zero()),
      [&](Eigen::Array4d& sum, block range) {
        const auto some = [&](const channel_values& all) { return all.middleCols(range.begin, range.size()); };
        const auto weight = some(weights).cast<double>();
        sum += Eigen::Array4d(weight.sum(), (weight * (some(wanted).cast<double>() - 1.0).square()).sum(),
                              (some(found) - 1.0f).abs().cast<double>().sum(),
                              static_cast<double>((some(inlier_weights) < 0.5f).count()));
      },
      threads);
  const auto count = static_cast<double>(weights.size());
  return {sums[0] > 0.0 ? std::sqrt(sums[1] / sums[0]) : 0.0, sums[2] / count, sums[3] / count};
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
