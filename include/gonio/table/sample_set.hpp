#pragma once
/// Scattered measurements of a BRDF: what a laboratory hands in, and every estimator takes.

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>

#include <Eigen/Core>

#include <concepts>
#include <iterator>
#include <type_traits>
#include <vector>

namespace gonio {

/// How much a measurement counts in each colour channel. A number alone counts in all three: `sample.weight = 0.5`.
class channel_weights {
 public:
  channel_weights(double of_all = 1.0) : of_each_(of_all, of_all, of_all) {}
  channel_weights(const rgb& of_each) : of_each_(of_each) {}

  [[nodiscard]] double operator[](Eigen::Index channel) const { return of_each_[channel]; }
  [[nodiscard]] const rgb& of_each() const noexcept { return of_each_; }
  [[nodiscard]] double mean() const { return of_each_.sum() / 3.0; }
  /// Do all channels count alike?
  [[nodiscard]] bool is_uniform() const noexcept { return of_each_[0] == of_each_[1] && of_each_[1] == of_each_[2]; }
  /// Does the measurement count in any channel?
  [[nodiscard]] bool counts() const noexcept { return of_each_[0] > 0.0 || of_each_[1] > 0.0 || of_each_[2] > 0.0; }

  [[nodiscard]] friend bool operator==(const channel_weights& a, const channel_weights& b) noexcept {
    return a.of_each_[0] == b.of_each_[0] && a.of_each_[1] == b.of_each_[1] && a.of_each_[2] == b.of_each_[2];
  }

 private:
  rgb of_each_;
};

/// The directions of a measurement as they were given: a pair, which keeps light and viewer apart, or half and
/// difference angles. Either is read from it; what was given is read back bit by bit.
class sample_directions {
 public:
  sample_directions() : sample_directions(half_difference{}) {}
  sample_directions(const direction_pair& pair) : pair_(pair), angles_(to_half_difference(pair.wi, pair.wo)) {}
  sample_directions(const half_difference& angles) : pair_(to_directions(angles)), angles_(angles) {}
  sample_directions(double theta_h, double theta_d, double phi_d)
      : sample_directions(half_difference{theta_h, theta_d, phi_d}) {}

  [[nodiscard]] const direction_pair& pair() const noexcept { return pair_; }
  [[nodiscard]] const half_difference& angles() const noexcept { return angles_; }

 private:
  direction_pair pair_;
  half_difference angles_;
};

/// One measurement: where, what (sr^-1, without the cosine; may be negative), and how much it counts.
struct sample {
  sample_directions directions = {};
  rgb value{0.0, 0.0, 0.0};
  channel_weights weight = {};

  [[nodiscard]] const half_difference& angles() const noexcept { return directions.angles(); }
};

/// Any range of measurements. A laboratory with a struct of its own hands it over in place:
/// `estimator.fit(readings | std::views::transform(to_sample))`.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/io/measurements/samples.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::sample_set samples = gonio::io::read_samples("measurements.csv");
///   gonio::require_usable(samples);
///   std::printf("%zu samples\n", samples.size());
/// }
/// ```
/// With a model of your own, the readings of a goniometer in a plane:
/// ```cpp
/// #include <gonio/estimate/decomposition.hpp>
/// #include <gonio/io/materials/prior.hpp>
/// #include <gonio/solve/tikhonov.hpp>
///
/// #include <cstdio>
/// #include <ranges>
/// #include <vector>
///
/// struct in_plane_reading {
///   double theta_i, theta_o, value;
/// };
///
/// int main() {
///   const std::vector<in_plane_reading> readings{{0.1, 0.4, 0.2}, {0.7, 0.7, 1.4}};
///   const auto to_sample = [](const in_plane_reading& r) {
///     const gonio::direction_pair pair{gonio::spherical_direction(r.theta_i, 0.0),
///                                      gonio::spherical_direction(r.theta_o, std::numbers::pi)};
///     return gonio::sample{pair, gonio::rgb::Constant(r.value), 1.0};
///   };
///   const auto prior = gonio::io::read_prior("materials.prior");
///   const auto samples = readings | std::views::transform(to_sample);
///   static_assert(gonio::sample_range<decltype(samples)>);
///   const auto paint = gonio::decomposition{prior, gonio::tikhonov{40.0}}.fit(samples);
///   std::printf("%g sr^-1\n", paint({0, 0, 1}, {0, 0, 1}).x());
/// }
/// ```
template <class Range>
concept sample_range = requires(Range& range) {
  { std::ranges::begin(range) } -> std::forward_iterator;
  { *std::ranges::begin(range) } -> std::convertible_to<sample>;
  std::ranges::end(range);
};

using sample_set = std::vector<sample>;
static_assert(sample_range<sample_set>);

namespace detail {

/// `number` counts from 1, for the message.
void require_usable_sample(const sample& s, Eigen::Index number);
[[noreturn]] void refuse_no_samples();

}  // namespace detail

/// Refuses what no estimator can use: throws gonio::error naming the first sample that is not finite, has
/// a negative weight, or has a direction at or below the horizon, or saying that there is none at all.
template <sample_range Samples>
void require_usable(const Samples& samples) {
  Eigen::Index number = 0;
  for (const sample& s : samples) detail::require_usable_sample(s, ++number);
  if (number == 0) detail::refuse_no_samples();
}

/// The positions of the measurements that count in any channel, which are those that estimators keep.
template <sample_range Samples>
[[nodiscard]] std::vector<Eigen::Index> counting_positions(const Samples& samples) {
  std::vector<Eigen::Index> positions;
  Eigen::Index position = 0;
  for (const sample& s : samples) {
    if (s.weight.counts()) positions.push_back(position);
    ++position;
  }
  return positions;
}

/// Does one of the measurements count more in one channel than in another? They are samples, or whatever else has a
/// `weight` of type `channel_weights`.
template <class Measurements>
[[nodiscard]] bool weigh_channels_apart(const Measurements& measurements) {
  using value = std::iter_value_t<decltype(std::ranges::begin(measurements))>;
  using measurement = std::conditional_t<sample_range<Measurements>, sample, value>;
  for (const measurement& each : measurements)
    if (!each.weight.is_uniform()) return true;
  return false;
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/sample_set.ipp>
#endif
