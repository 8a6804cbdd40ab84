#pragma once
/// Bodies of estimate/outlier_mixture.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/sample_regions.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

namespace gonio {

namespace detail {

/// Samples whose weights are computed together: their logarithms stay in the cache.
inline constexpr Eigen::Index samples_at_once = 4096;

/// The share p at which the sum of ln(p g + (1 - p) o) + ln p is largest: g and o are what good ones' and outliers'
/// densities are at each measurement. By bisection of its slope, which falls with p.
[[nodiscard]] GONIO_INLINE double most_probable_share(const Eigen::ArrayXd& good, const Eigen::ArrayXd& outliers) {
  const Eigen::ArrayXd difference = good - outliers;
  const auto slope = [&](double share) { return (difference / (outliers + share * difference)).sum() + 1.0 / share; };
  double low = 0.02, high = 0.999;
  if (slope(high) >= 0.0) return high;
  for (int step = 0; step < 30; ++step) {
    const double middle = 0.5 * (low + high);
    (slope(middle) > 0.0 ? low : high) = middle;
  }
  return low;
}

}  // namespace detail

GONIO_INLINE outlier_mixture estimate_mixture(const std::vector<double>& residuals, const std::vector<double>& outliers,
                                              outlier_mixture start) {
  constexpr double nu = outlier_mixture::degrees_of_freedom;
  const Eigen::ArrayXd all = Eigen::ArrayXd::Map(residuals.data(), std::ssize(residuals));
  const Eigen::ArrayXd densities = Eigen::ArrayXd::Map(outliers.data(), std::ssize(outliers));
  outlier_mixture now = start;
  for (int step = 0; step < 50; ++step) {
    const Eigen::ArrayXd shares = now.probability(all, densities);
    const double good = shares.sum();
    const double squares = (nu + 1.0) / nu * (shares * now.tail_weight(all) * all.square()).sum();
    outlier_mixture next{now.inlier_fraction, std::max(std::sqrt(squares / good), outlier_mixture::smallest_scale)};
    next.inlier_fraction = detail::most_probable_share(next.good_density(all), densities);
    const bool settled = std::abs(next.inlier_fraction - now.inlier_fraction) < 1e-4 &&
                         std::abs(next.scale - now.scale) < 1e-3 * now.scale;
    now = next;
    if (settled) break;
  }
  return now;
}

GONIO_INLINE channel_values automatic_weights::weigh(const channel_values& measured,
                                                     const channel_values& estimated) const {
  deviations found = deviate(measured, estimated);
  const outlier_mixture mixture = estimate_from(found);
  // Distances are larger than residuals, the more so the less the channels have in common.
  found.distance *= static_cast<float>(mixture.scale / scale_of_distances(found, mixture));
  Eigen::ArrayXf weights(measured.cols());
  if (regions) {
    const double typical = half_of_the_good(found.distance, regions->all(), mixture.inlier_fraction);
    for_each_index(
        regions->count(), 1,
        [&](Eigen::Index region) {
          const std::span<const Eigen::Index> here = (*regions)[region];
          const double ratio = half_of_the_good(found.distance, here, mixture.inlier_fraction) / typical;
          const outlier_mixture own = rescaled(mixture, ratio);
          for (const Eigen::Index i : here) weights[i] = weigh(own, found, i);
        },
        threads);
  } else {
    for_each_index(
        weights.size(), detail::samples_at_once, [&](Eigen::Index i) { weights[i] = weigh(mixture, found, i); },
        threads);
  }
  channel_values each(3, weights.size());
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    for (Eigen::Index c = 0; c < 3; ++c) each(c, i) = weights[i];
  return each;
}

GONIO_INLINE outlier_mixture automatic_weights::mixture(const channel_values& measured,
                                                        const channel_values& estimated) const {
  return estimate_from(deviate(measured, estimated));
}

GONIO_INLINE Eigen::Array3f automatic_weights::offsets(const channel_values& measured, thread_count threads) {
  Eigen::Array3f found;
  for_each_index(
      3, 1, [&](Eigen::Index c) { found[c] = static_cast<float>(logarithm_offset(measured.row(c))); }, threads);
  return found;
}

GONIO_INLINE automatic_weights::deviations automatic_weights::deviate(const channel_values& measured,
                                                                      const channel_values& estimated) const {
  const Eigen::Index count = measured.cols();
  const Eigen::Array3f offset = offsets(measured, threads);
  deviations found{Eigen::ArrayXf(count), Eigen::ArrayXf(count), Eigen::ArrayXf(count), Eigen::ArrayXd(count)};
  for_each_index(
      count, detail::samples_at_once,
      [&](Eigen::Index i) {
        std::array<float, 3> logarithm{}, residual{};
        for (Eigen::Index c = 0; c < 3; ++c) {
          logarithm[c] = std::log(std::max(measured(c, i), 0.0f) + offset[c]);
          residual[c] = logarithm[c] - std::log(estimated(c, i) + offset[c]);
        }
        const auto mean = [](float a, float b, float c) { return (a + (b + c)) / 3.0f; };
        found.residual[i] = mean(residual[0], residual[1], residual[2]);
        found.distance[i] =
            std::sqrt(mean(residual[0] * residual[0], residual[1] * residual[1], residual[2] * residual[2]));
        found.logarithm[i] = mean(logarithm[0], logarithm[1], logarithm[2]);
      },
      threads);
  const outlier_density density(subset(found.logarithm));
  for_each_index(
      count, detail::samples_at_once, [&](Eigen::Index i) { found.outliers[i] = density(found.logarithm[i]); },
      threads);
  return found;
}

GONIO_INLINE float automatic_weights::weigh(const outlier_mixture& mixture, const deviations& found,
                                            Eigen::Index sample) const {
  const double good = mixture.probability(double{found.residual[sample]}, found.outliers[sample]);
  return static_cast<float>(down_weight_tail ? good * mixture.tail_weight(double{found.distance[sample]}) : good);
}

GONIO_INLINE double automatic_weights::scale_of_distances(const deviations& found,
                                                          const outlier_mixture& mixture) const {
  constexpr double nu = outlier_mixture::degrees_of_freedom;
  const Eigen::Index count = found.residual.size();
  // Squared distances, and how much each counts: its probability to be good.
  Eigen::ArrayXd squares(count), good(count);
  for_each_index(
      count, detail::samples_at_once,
      [&](Eigen::Index i) {
        const double distance = found.distance[i];
        squares[i] = distance * distance;
        good[i] = mixture.probability(double{found.residual[i]}, found.outliers[i]);
      },
      threads);
  // The sum of good / (1 + inverse squares), times the squares or not.
  const auto sum = [&](double inverse, bool of_squares) {
    return sum_over_blocks(
        count, detail::samples_at_once, 0.0,
        [&](double& total, block range) {
          for (Eigen::Index i = range.begin; i < range.end; ++i)
            total += good[i] * (of_squares ? squares[i] : 1.0) / (1.0 + inverse * squares[i]);
        },
        threads);
  };
  const double total = sum(0.0, false);
  double scale = mixture.scale;
  for (int step = 0; step < 20; ++step) {
    const double inverse = 1.0 / (nu * scale * scale);
    const double weighted = sum(inverse, true);
    scale = std::max(std::sqrt((nu + 1.0) / nu * weighted / total), mixture.scale);
  }
  return scale;
}

GONIO_INLINE double automatic_weights::half_of_the_good(const Eigen::ArrayXf& residuals,
                                                        std::span<const Eigen::Index> samples, double inlier_fraction) {
  std::vector<float> sorted;
  sorted.reserve(samples.size());
  for (const Eigen::Index sample : samples) sorted.push_back(residuals[sample]);
  // Of n values, not of the n - 1 steps between them as `quantile` has it: a region may have but eight samples.
  const auto middle = static_cast<std::ptrdiff_t>(0.5 * inlier_fraction * static_cast<double>(sorted.size()));
  return std::max(double{nth_smallest(sorted, middle)}, 1e-6);
}

GONIO_INLINE outlier_mixture automatic_weights::rescaled(const outlier_mixture& mixture, double ratio) {
  return {mixture.inlier_fraction,
          std::clamp(ratio * mixture.scale, outlier_mixture::smallest_scale, std::max(mixture.scale, 1.0))};
}

GONIO_INLINE outlier_mixture automatic_weights::estimate_from(const deviations& found) {
  return estimate_mixture(subset(found.residual), subset(found.outliers));
}

}  // namespace gonio
