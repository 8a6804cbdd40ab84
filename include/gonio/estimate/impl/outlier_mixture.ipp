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

GONIO_INLINE outlier_density::outlier_density(const std::vector<double>& logarithms) : density_(bins, 0.0) {
  // Count the logarithms in bins over their range, extended by half a unit on each side.
  const auto [least, most] = std::ranges::minmax_element(logarithms);
  const auto n = static_cast<double>(logarithms.size());
  lowest_ = *least - 0.5;
  step_ = (*most - *least + 1.0) / static_cast<double>(bins);
  std::vector<double> counts(bins, 0.0);
  double mean = 0.0, square = 0.0;
  for (const double value : logarithms) {
    counts[std::min(bins - 1, static_cast<Eigen::Index>((value - lowest_) / step_))] += 1.0;
    mean += value / n;
    square += value * value / n;
  }
  // Smooth by a Gaussian of Silverman's width.
  const double deviation = std::sqrt(std::max(square - mean * mean, 0.0));
  const double width = std::max(1.06 * deviation * std::pow(n, -0.2), step_);
  const auto reach = static_cast<std::ptrdiff_t>(3.0 * width / step_) + 1;
  for (std::ptrdiff_t i = 0; i < std::ssize(counts); ++i)
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(i - reach, 0); j <= std::min(i + reach, std::ssize(counts) - 1);
         ++j) {
      const double z = static_cast<double>(i - j) * step_ / width;
      density_[j] += counts[i] * std::exp(-0.5 * z * z);
    }
  // Flatten by a square root. In bins without measurements, assume a tenth of a measurement.
  double total = 0.0;
  for (double& value : density_) {
    value = std::sqrt(std::max(value / (n * width * std::sqrt(2.0 * std::numbers::pi)), 0.1 / n));
    total += value * step_;
  }
  for (double& value : density_) value /= total;
}

namespace detail {

/// The number of samples whose weights are computed at a time, so that their logarithms stay in the cache.
inline constexpr Eigen::Index samples_at_once = 4096;

/// Returns the inlier fraction p that maximises ln p plus the sum of ln(p g + (1 - p) o), where g and o are the
/// densities of inliers and of outliers at each measurement. Bisects the slope, which decreases with p.
[[nodiscard]] GONIO_INLINE double most_probable_share(const Eigen::VectorXd& inliers,
                                                      const std::vector<double>& outliers) {
  Eigen::VectorXd term(inliers.size());
  const auto slope = [&](double share) {
    for (Eigen::Index i = 0; i < term.size(); ++i)
      term[i] = (inliers[i] - outliers[i]) / (outliers[i] + share * (inliers[i] - outliers[i]));
    return term.sum() + 1.0 / share;
  };
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
  Eigen::VectorXd shares(std::ssize(residuals)), on_tail(shares.size()), densities(shares.size());
  outlier_mixture now = start;
  for (int step = 0; step < 50; ++step) {
    for (Eigen::Index i = 0; i < shares.size(); ++i) {
      shares[i] = now.probability(residuals[i], outliers[i]);
      on_tail[i] = shares[i] * now.tail_weight(residuals[i]) * (residuals[i] * residuals[i]);
    }
    const double inliers = shares.sum(), squares = (nu + 1.0) / nu * on_tail.sum();
    outlier_mixture next{now.inlier_fraction, std::max(std::sqrt(squares / inliers), outlier_mixture::smallest_scale)};
    for (Eigen::Index i = 0; i < shares.size(); ++i) densities[i] = next.inlier_density(residuals[i]);
    next.inlier_fraction = detail::most_probable_share(densities, outliers);
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
  // Scale the distances: they are larger than residuals, most of all if the channels differ.
  const auto scale = static_cast<float>(mixture.scale / scale_of_distances(found, mixture));
  for (float& distance : found.distance) distance *= scale;
  std::vector<float> weights(measured.cols());
  if (regions) {
    const double typical = median_of_inliers(found.distance, regions->all(), mixture.inlier_fraction);
    for_each_index(
        regions->count(), 1,
        [&](Eigen::Index region) {
          const std::span<const Eigen::Index> here = (*regions)[region];
          const double ratio = median_of_inliers(found.distance, here, mixture.inlier_fraction) / typical;
          const outlier_mixture own = rescaled(mixture, ratio);
          for (const Eigen::Index i : here) weights[i] = weigh(own, found, i);
        },
        threads);
  } else {
    for_each_index(
        weights.size(), detail::samples_at_once, [&](Eigen::Index i) { weights[i] = weigh(mixture, found, i); },
        threads);
  }
  channel_values each(3, std::ssize(weights));
  for (Eigen::Index i = 0; i < each.cols(); ++i)
    for (Eigen::Index c = 0; c < 3; ++c) each(c, i) = weights[i];
  return each;
}

GONIO_INLINE outlier_mixture automatic_weights::mixture(const channel_values& measured,
                                                        const channel_values& estimated) const {
  return estimate_from(deviate(measured, estimated));
}

GONIO_INLINE double logarithm_offset(std::vector<double> measured) {
  return std::max(1e-4, 0.01 * upper_median(measured));
}

GONIO_INLINE std::array<float, 3> automatic_weights::offsets(const channel_values& measured) {
  std::array<float, 3> found{};
  for (Eigen::Index c = 0; c < 3; ++c) {
    std::vector<double> channel(measured.cols());
    for (Eigen::Index i = 0; i < measured.cols(); ++i) channel[i] = double{measured(c, i)};
    found[c] = static_cast<float>(logarithm_offset(std::move(channel)));
  }
  return found;
}

GONIO_INLINE automatic_weights::deviations automatic_weights::deviate(const channel_values& measured,
                                                                      const channel_values& estimated) const {
  const Eigen::Index count = measured.cols();
  const std::array<float, 3> offset = offsets(measured);
  std::vector<float> zeros(count);
  deviations found{zeros, zeros, zeros, std::vector<double>(count)};
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
  const double probability = mixture.probability(double{found.residual[sample]}, found.outliers[sample]);
  return static_cast<float>(down_weight_tail ? probability * mixture.tail_weight(double{found.distance[sample]})
                                             : probability);
}

GONIO_INLINE double automatic_weights::scale_of_distances(const deviations& found,
                                                          const outlier_mixture& mixture) const {
  constexpr double nu = outlier_mixture::degrees_of_freedom;
  const Eigen::Index count = std::ssize(found.residual);
  // Compute squared distances, and the probability that each sample is an inlier.
  std::vector<double> squares(count), probabilities(count);
  for_each_index(
      count, detail::samples_at_once,
      [&](Eigen::Index i) {
        const double distance = found.distance[i];
        squares[i] = distance * distance;
        probabilities[i] = mixture.probability(double{found.residual[i]}, found.outliers[i]);
      },
      threads);
  // Returns the sum of probability / (1 + inverse * square) over the samples. If `of_squares`, each term is multiplied
  // by its square.
  const auto sum = [&](double inverse, bool of_squares) {
    return sum_over_blocks(
        count, detail::samples_at_once, 0.0,
        [&](double& total, block range) {
          for (Eigen::Index i = range.begin; i < range.end; ++i)
            total += probabilities[i] * (of_squares ? squares[i] : 1.0) / (1.0 + inverse * squares[i]);
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

GONIO_INLINE double automatic_weights::median_of_inliers(const std::vector<float>& residuals,
                                                         std::span<const Eigen::Index> samples,
                                                         double inlier_fraction) {
  std::vector<double> sorted;
  sorted.reserve(samples.size());
  for (const Eigen::Index sample : samples) sorted.push_back(double{residuals[sample]});
  // Take the median of the n * inlier_fraction smallest values. Count values, not the n - 1 steps between them as
  // `quantile` does, because a region may have only eight samples.
  const auto middle = static_cast<std::ptrdiff_t>(0.5 * inlier_fraction * static_cast<double>(sorted.size()));
  return std::max(nth_smallest(sorted, middle), 1e-6);
}

GONIO_INLINE outlier_mixture automatic_weights::rescaled(const outlier_mixture& mixture, double ratio) {
  return {mixture.inlier_fraction,
          std::clamp(ratio * mixture.scale, outlier_mixture::smallest_scale, std::max(mixture.scale, 1.0))};
}

GONIO_INLINE outlier_mixture automatic_weights::estimate_from(const deviations& found) {
  return estimate_mixture(subset(found.residual), subset(found.outliers));
}

}  // namespace gonio
