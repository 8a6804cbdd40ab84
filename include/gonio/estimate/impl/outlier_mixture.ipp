#pragma once
/// Bodies of estimate/outlier_mixture.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/outlier_weights.hpp>
#include <gonio/estimate/sample_regions.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

namespace gonio {

namespace detail {

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
  const outlier_density density(subset(found.logarithm));
  const outlier_mixture mixture = estimate_from(found, density);
  // Distances are larger than residuals, the more so the less the channels have in common.
  found.distance *= static_cast<float>(mixture.scale / scale_of_distances(found, density, mixture));
  Eigen::ArrayXd weights(measured.cols());
  if (regions) {
    const double typical = half_of_the_good(found.distance, regions->all(), mixture.inlier_fraction);
    for (Eigen::Index region = 0; region < regions->count(); ++region) {
      const std::span<const Eigen::Index> here = (*regions)[region];
      const double ratio = half_of_the_good(found.distance, here, mixture.inlier_fraction) / typical;
      weights(here) = weigh(rescaled(mixture, ratio), found, density, here);
    }
  } else {
    std::vector<Eigen::Index> all(measured.cols());
    std::iota(all.begin(), all.end(), Eigen::Index{0});
    weights = weigh(mixture, found, density, all);
  }
  return weights.cast<float>().transpose().replicate<3, 1>();
}

GONIO_INLINE outlier_mixture automatic_weights::mixture(const channel_values& measured,
                                                        const channel_values& estimated) const {
  const deviations found = deviate(measured, estimated);
  return estimate_from(found, outlier_density(subset(found.logarithm)));
}

GONIO_INLINE Eigen::Array3f automatic_weights::offsets(const channel_values& measured) {
  return {static_cast<float>(logarithm_offset(measured.row(0))), static_cast<float>(logarithm_offset(measured.row(1))),
          static_cast<float>(logarithm_offset(measured.row(2)))};
}

GONIO_INLINE automatic_weights::deviations automatic_weights::deviate(const channel_values& measured,
                                                                      const channel_values& estimated) {
  const Eigen::Array3f offset = offsets(measured);
  const channel_values logarithms = (measured.max(0.0f).colwise() + offset).log();
  const channel_values differences = logarithms - (estimated.colwise() + offset).log();
  return {differences.colwise().mean().transpose(), differences.square().colwise().mean().sqrt().transpose(),
          logarithms.colwise().mean().transpose()};
}

GONIO_INLINE Eigen::ArrayXd automatic_weights::weigh(const outlier_mixture& mixture, const deviations& found,
                                                     const outlier_density& density,
                                                     std::span<const Eigen::Index> samples) const {
  const Eigen::ArrayXd residuals = found.residual(samples).cast<double>(),
                       distances = found.distance(samples).cast<double>();
  const Eigen::ArrayXd outliers = found.logarithm(samples).unaryExpr([&](float value) { return density(value); });
  const Eigen::ArrayXd good = mixture.probability(residuals, outliers);
  return down_weight_tail ? Eigen::ArrayXd(good * mixture.tail_weight(distances)) : good;
}

GONIO_INLINE double automatic_weights::scale_of_distances(const deviations& found, const outlier_density& density,
                                                          const outlier_mixture& mixture) {
  constexpr double nu = outlier_mixture::degrees_of_freedom;
  const Eigen::ArrayXd outliers = found.logarithm.unaryExpr([&](float value) { return density(value); });
  const Eigen::ArrayXd good = mixture.probability(Eigen::ArrayXd(found.residual.cast<double>()), outliers),
                       squares = found.distance.cast<double>().square();
  double scale = mixture.scale;
  for (int step = 0; step < 20; ++step) {
    const Eigen::ArrayXd tail = 1.0 / (1.0 + squares / (nu * scale * scale));
    scale = std::max(std::sqrt((nu + 1.0) / nu * (good * tail * squares).sum() / good.sum()), mixture.scale);
  }
  return scale;
}

GONIO_INLINE double automatic_weights::half_of_the_good(const Eigen::ArrayXf& residuals,
                                                        std::span<const Eigen::Index> samples, double inlier_fraction) {
  std::vector<float> sorted;
  for (const Eigen::Index sample : samples) sorted.push_back(residuals[sample]);
  // Of n values, not of the n - 1 steps between them as `quantile` has it: a region may have but eight samples.
  const auto middle =
      sorted.begin() + static_cast<std::ptrdiff_t>(0.5 * inlier_fraction * static_cast<double>(sorted.size()));
  std::ranges::nth_element(sorted, middle);
  return std::max(double{*middle}, 1e-6);
}

GONIO_INLINE outlier_mixture automatic_weights::rescaled(const outlier_mixture& mixture, double ratio) {
  return {mixture.inlier_fraction,
          std::clamp(ratio * mixture.scale, outlier_mixture::smallest_scale, std::max(mixture.scale, 1.0))};
}

GONIO_INLINE std::vector<double> automatic_weights::subset(const Eigen::ArrayXf& values) {
  const Eigen::Index step = (values.size() + 19'999) / 20'000;
  std::vector<double> chosen;
  for (Eigen::Index i = 0; i < values.size(); i += step) chosen.push_back(values[i]);
  return chosen;
}

GONIO_INLINE outlier_mixture automatic_weights::estimate_from(const deviations& found, const outlier_density& density) {
  std::vector<double> outliers = subset(found.logarithm);
  for (double& value : outliers) value = density(value);
  return estimate_mixture(subset(found.residual), outliers);
}

}  // namespace gonio
