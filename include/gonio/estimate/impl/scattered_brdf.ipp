#pragma once
/// Bodies of estimate/scattered_brdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/k_d_tree.hpp>
#include <gonio/estimate/scattered_brdf.hpp>
#include <gonio/metric/log_relative.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

namespace gonio::detail {

/// As `log_relative` of a reference of zero and no cosines.
[[nodiscard]] GONIO_INLINE double to_domain(interpolation_domain domain, double rho) noexcept {
  return domain == interpolation_domain::reflectance ? rho : log_relative::forward(rho, 0.0, 1.0);
}

[[nodiscard]] GONIO_INLINE double from_domain(interpolation_domain domain, double y) noexcept {
  return domain == interpolation_domain::reflectance ? y : log_relative::inverse(y, 0.0, 1.0);
}

/// The two in an order that does not depend on which of them is the light.
[[nodiscard]] GONIO_INLINE bool is_ordered(const direction& wi, const direction& wo) noexcept {
  return std::tuple(wi.z(), wi.x(), wi.y()) <= std::tuple(wo.z(), wo.x(), wo.y());
}

}  // namespace gonio::detail

namespace gonio {

/// The tree reads the points where they are, so that this stays where it is.
struct scattered_brdf::embedded_samples {
  embedded_samples(const sample_set& samples, const std::vector<Eigen::Index>& counting, Eigen::Index channel,
                   const scattered_options& options)
      : points(4, std::ssize(counting)),
        values(3, std::ssize(counting)),
        weights(std::ssize(counting)),
        tree(fill(samples, counting, channel, options)) {}

  Eigen::Matrix4Xd points;
  Eigen::Array3Xd values;  ///< in the domain of the interpolation
  Eigen::VectorXd weights;
  k_d_tree<4> tree;

 private:
  const Eigen::Matrix4Xd& fill(const sample_set& samples, const std::vector<Eigen::Index>& counting,
                               Eigen::Index channel, const scattered_options& options) {
    for (Eigen::Index i = 0; i < std::ssize(counting); ++i) {
      const sample& s = samples[counting[i]];
      const std::array<double, 4> place = options.embedding(s.angles());
      std::ranges::copy(place, points.col(i).data());
      for (Eigen::Index c = 0; c < 3; ++c) values(c, i) = detail::to_domain(options.domain, s.value[c]);
      weights[i] = s.weight[channel];
    }
    return points;
  }
};

GONIO_INLINE rgb scattered_brdf::mean_of_neighbours(const embedded_samples& of,
                                                    const std::array<double, 4>& place) const noexcept {
  // One more than are averaged: its distance is where weights end.
  std::array<std::uint32_t, scattered_options::most_neighbours + 1> numbers;
  std::array<double, scattered_options::most_neighbours + 1> distances;
  const Eigen::Index found = of.tree.nearest(place.data(), options_.neighbours + 1, numbers.data(), distances.data()),
                     count = std::min(found, options_.neighbours);
  // A distance of rounding errors is none. The end lies a little beyond the next one: weights of equally near
  // neighbours would be rounding errors, too.
  constexpr double least = 1e-12, beyond = 1.0 + 1e-6;
  for (Eigen::Index i = 0; i < found; ++i) distances[i] = std::max(std::sqrt(distances[i]), least);
  const double end = beyond * distances[found - 1];
  const auto closeness = [&](double distance) {
    return found > count ? (end - distance) / (end * distance) : 1.0 / distance;
  };
  // Relative to the nearest, so that nothing overflows.
  const double closest = closeness(distances[0]);
  rgb sum = rgb::Zero();
  double weights = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double weight = of.weights[numbers[i]] * std::pow(closeness(distances[i]) / closest, options_.exponent);
    sum += weight * of.values.col(numbers[i]);
    weights += weight;
  }
  rgb mean;
  for (Eigen::Index c = 0; c < 3; ++c) mean[c] = std::max(detail::from_domain(options_.domain, sum[c] / weights), 0.0);
  return mean;
}

GONIO_INLINE rgb scattered_brdf::operator()(const direction& wi, const direction& wo) const noexcept {
  if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
  const bool ordered = detail::is_ordered(wi, wo);
  const std::array<double, 4> place =
      options_.embedding(ordered ? to_half_difference(wi, wo) : to_half_difference(wo, wi));
  if (channels_.size() == 1) return mean_of_neighbours(*channels_.front(), place);
  rgb value;
  for (Eigen::Index c = 0; c < 3; ++c) value[c] = mean_of_neighbours(*channels_[c], place)[c];
  return value;
}

GONIO_INLINE scattered_brdf scattered_interpolation::fit(const sample_set& samples) const {
  require_usable(samples);
  scattered_brdf fitted(options_);
  const Eigen::Index channels = weigh_channels_apart(samples) ? 3 : 1;
  for (Eigen::Index channel = 0; channel < channels; ++channel) {
    std::vector<Eigen::Index> counting;
    for (Eigen::Index i = 0; i < std::ssize(samples); ++i)
      if (samples[i].weight[channel] > 0.0) counting.push_back(i);
    if (counting.empty())
      refuse(channels == 1 ? "all samples have weight zero: nothing is known"
                           : "all samples have weight zero in one of the channels: nothing is known of it");
    fitted.channels_.push_back(
        std::make_shared<const scattered_brdf::embedded_samples>(samples, counting, channel, options_));
  }
  return fitted;
}

}  // namespace gonio
