#pragma once
/// Bodies of interpolate/scattered_brdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/k_d_tree.hpp>
#include <gonio/interpolate/scattered_brdf.hpp>
#include <gonio/metric/log_relative.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace gonio::detail {

/// Maps reflectance to the domain. The logarithm is `log_relative` with a reference of zero and no cosines.
[[nodiscard]] GONIO_INLINE double to_domain(interpolation_domain domain, double rho) noexcept {
  return domain == interpolation_domain::reflectance ? rho : log_relative::forward(rho, 0.0, 1.0);
}

[[nodiscard]] GONIO_INLINE double from_domain(interpolation_domain domain, double y) noexcept {
  return domain == interpolation_domain::reflectance ? y : log_relative::inverse(y, 0.0, 1.0);
}

/// Orders the two directions: true for exactly one of (wi, wo) and (wo, wi), unless they are equal.
[[nodiscard]] GONIO_INLINE bool is_ordered(const direction& wi, const direction& wo) noexcept {
  return std::tuple(wi.z(), wi.x(), wi.y()) <= std::tuple(wo.z(), wo.x(), wo.y());
}

/// The location of a sample in the embedding space, and the sample's number in the set.
using sample_location = std::pair<std::array<double, 4>, Eigen::Index>;

/// Returns the samples of positive weight in a channel, sorted by location, so that repeats are adjacent.
[[nodiscard]] GONIO_INLINE std::vector<sample_location> sorted_locations(const sample_set& samples,
                                                                         Eigen::Index channel,
                                                                         const pair_embedding& embedding) {
  std::vector<sample_location> locations;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i)
    if (samples[i].weight[channel] > 0.0) locations.emplace_back(embedding(samples[i].angles()), i);
  std::ranges::sort(locations);
  return locations;
}

}  // namespace gonio::detail

namespace gonio {

/// The samples of positive weight, as points of a search tree. The tree reads the points in place, so the samples
/// cannot be moved.
struct scattered_brdf::embedded_samples {
  /// `locations` must not be empty.
  embedded_samples(const sample_set& samples, const std::vector<detail::sample_location>& locations,
                   Eigen::Index channel, interpolation_domain domain)
      : points(4, std::ssize(locations)),
        values(Eigen::Array3Xd::Zero(3, std::ssize(locations))),
        weights(Eigen::VectorXd::Zero(std::ssize(locations))),
        tree(merge(samples, locations, channel, domain)) {}

  Eigen::Matrix4Xd points;
  Eigen::Array3Xd values;  ///< in the domain of the interpolation
  Eigen::VectorXd weights;
  k_d_tree<4> tree;

 private:
  /// Merges measurements of the same location into one point. The point has the weighted mean of their reflectances, so
  /// that noise cancels.
  const Eigen::Matrix4Xd& merge(const sample_set& samples, const std::vector<detail::sample_location>& locations,
                                Eigen::Index channel, interpolation_domain domain) {
    Eigen::Index merged = 0;
    for (Eigen::Index i = 0; i < std::ssize(locations); ++i) {
      const auto& [point, number] = locations[i];
      if (i > 0 && point != locations[i - 1].first) ++merged;
      std::ranges::copy(point, points.col(merged).data());
      values.col(merged) += samples[number].weight[channel] * samples[number].value;
      weights[merged] += samples[number].weight[channel];
    }
    ++merged;
    points.conservativeResize(Eigen::NoChange, merged);
    values.conservativeResize(Eigen::NoChange, merged);
    weights.conservativeResize(merged);
    for (Eigen::Index i = 0; i < merged; ++i)
      for (Eigen::Index c = 0; c < 3; ++c) values(c, i) = detail::to_domain(domain, values(c, i) / weights[i]);
    return points;
  }
};

GONIO_INLINE rgb scattered_brdf::mean_of_neighbours(const embedded_samples& of,
                                                    const std::array<double, 4>& at) const noexcept {
  // Find one neighbour more than the mean uses: weights vanish at its distance.
  std::array<std::uint32_t, scattered_options::most_neighbours + 1> numbers;
  std::array<double, scattered_options::most_neighbours + 1> distances;
  const Eigen::Index found = of.tree.nearest(at.data(), options_.neighbours + 1, numbers.data(), distances.data()),
                     count = std::min(found, options_.neighbours);
  // Replace distances that are rounding errors by a small distance. Let weights vanish slightly farther out than the
  // next neighbour; otherwise, if all neighbours are equally near, their weights would be rounding errors.
  constexpr double least = 1e-12, beyond = 1.0 + 1e-6;
  for (Eigen::Index i = 0; i < found; ++i) distances[i] = std::max(std::sqrt(distances[i]), least);
  const double end = beyond * distances[found - 1];
  const auto closeness = [&](double distance) {
    return found > count ? (end - distance) / (end * distance) : 1.0 / distance;
  };
  // Divide all weights by that of the nearest sample, so that nothing overflows.
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
  const std::array<double, 4> at =
      options_.embedding(ordered ? to_half_difference(wi, wo) : to_half_difference(wo, wi));
  if (channels_.size() == 1) return mean_of_neighbours(*channels_.front(), at);
  rgb value;
  for (Eigen::Index c = 0; c < 3; ++c) value[c] = mean_of_neighbours(*channels_[c], at)[c];
  return value;
}

GONIO_INLINE scattered_brdf scattered_interpolation::fit(const sample_set& samples) const {
  require_usable(samples);
  scattered_brdf fitted(options_);
  const Eigen::Index channels = weigh_channels_apart(samples) ? 3 : 1;
  for (Eigen::Index channel = 0; channel < channels; ++channel) {
    const std::vector<detail::sample_location> locations =
        detail::sorted_locations(samples, channel, options_.embedding);
    if (locations.empty())
      refuse(channels == 1 ? "all samples have weight zero" : "all samples have weight zero in one of the channels");
    fitted.channels_.push_back(
        std::make_shared<const scattered_brdf::embedded_samples>(samples, locations, channel, options_.domain));
  }
  return fitted;
}

}  // namespace gonio
