#pragma once
/// Scattered measurements of a BRDF: the input of every estimator.

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/table/aperture.hpp>
#include <gonio/table/channels.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio {

/// The weight of a measurement in each colour channel. A single number applies to all three: `sample.weight = 0.5`.
class channel_weights {
 public:
  channel_weights(double of_all = 1.0) : of_each_(of_all, of_all, of_all) {}
  channel_weights(const rgb& of_each) : of_each_(of_each) {}

  [[nodiscard]] double operator[](Eigen::Index channel) const { return of_each_[channel]; }
  [[nodiscard]] const rgb& of_each() const noexcept { return of_each_; }
  [[nodiscard]] double mean() const { return of_each_.sum() / 3.0; }
  /// Returns true if all channels have the same weight.
  [[nodiscard]] bool is_uniform() const noexcept { return of_each_[0] == of_each_[1] && of_each_[1] == of_each_[2]; }
  /// Returns true if the measurement has a positive weight in any channel.
  [[nodiscard]] bool counts() const noexcept { return of_each_[0] > 0.0 || of_each_[1] > 0.0 || of_each_[2] > 0.0; }

  [[nodiscard]] friend bool operator==(const channel_weights& a, const channel_weights& b) noexcept {
    return a.of_each_[0] == b.of_each_[0] && a.of_each_[1] == b.of_each_[1] && a.of_each_[2] == b.of_each_[2];
  }

 private:
  rgb of_each_;
};

/// The directions of a measurement: a pair, which distinguishes light and viewer, or half and difference angles. Both
/// forms can be read. The given form is stored exactly.
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

/// One measurement: directions, value (sr^-1, without the cosine; may be negative), weight, and the cones of directions
/// over which the value is a mean.
struct sample {
  sample_directions directions = {};
  rgb value{0.0, 0.0, 0.0};
  channel_weights weight = {};
  gonio::aperture aperture = {};

  [[nodiscard]] const half_difference& angles() const noexcept { return directions.angles(); }
};

/// A range of measurements in colours, from which a `sample_set` can be made. To use a struct of your own:
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

/// Measurements in the same channels, by default colours. With colours, or with one channel (stored as equal red, green
/// and blue), the set is a sequence of `sample`. With several wavelengths, access as a sequence throws gonio::error,
/// and `colours` converts the set.
///
/// ```cpp
/// gonio::sample_set paint(gonio::channels({450.0, 550.0, 650.0}));
/// paint.add(pair, std::array{0.11, 0.32, 0.08});
/// const gonio::rgb seen = paint.under(gonio::illuminant::a).colours()[0].value;
/// ```
class sample_set {
 public:
  using value_type = sample;
  using iterator = std::vector<sample>::iterator;
  using const_iterator = std::vector<sample>::const_iterator;

  sample_set() = default;
  explicit sample_set(gonio::channels kinds) : channels_(std::move(kinds)) {}
  sample_set(std::initializer_list<sample> some) : rows_(some) {}
  explicit sample_set(std::size_t count, const sample& each = {}) : rows_(count, each) {}
  template <std::input_iterator Iterator>
  sample_set(Iterator first, Iterator last) : rows_(first, last) {}
  /// Takes any range of samples in colours.
  template <sample_range Samples>
  requires(!std::same_as<std::remove_cvref_t<Samples>, sample_set>) sample_set(const Samples& some)
      : sample_set(std::ranges::begin(some), std::ranges::end(some)) {}

  [[nodiscard]] const gonio::channels& channels() const noexcept { return channels_; }
  [[nodiscard]] std::size_t size() const noexcept { return rows_.size(); }
  [[nodiscard]] bool empty() const noexcept { return rows_.empty(); }
  void reserve(std::size_t count) { rows_.reserve(count); }

  // ---- in any channels ----

  /// Adds a measurement with a value for each channel, sr^-1.
  void add(const sample_directions& directions, std::span<const double> values, const channel_weights& weight = 1.0,
           const gonio::aperture& aperture = {});
  void add(const sample_directions& directions, const Eigen::ArrayXd& values, const channel_weights& weight = 1.0,
           const gonio::aperture& aperture = {}) {
    add(directions, std::span(values.data(), static_cast<std::size_t>(values.size())), weight, aperture);
  }
  [[nodiscard]] const sample_directions& directions(Eigen::Index i) const noexcept { return rows_[i].directions; }
  /// Returns the values of measurement i: one for each channel, sr^-1.
  [[nodiscard]] std::span<const double> values(Eigen::Index i) const noexcept {
    const Eigen::Index count = channels_.size();
    const double* first = channels_.are_wavelengths() ? spectra_.data() + i * count : rows_[i].value.data();
    return {first, static_cast<std::size_t>(count)};
  }
  /// Replaces the value of measurement i in one channel, sr^-1.
  void set_value(Eigen::Index i, Eigen::Index channel, double value) noexcept {
    if (channels_.are_wavelengths())
      spectra_[i * channels_.size() + channel] = value;
    else if (channels_.size() == 1)
      rows_[i].value = rgb::Constant(value);
    else
      rows_[i].value[channel] = value;
  }
  /// Returns the weight of a measurement. All wavelengths have the same weight.
  [[nodiscard]] const channel_weights& weight(Eigen::Index i) const noexcept { return rows_[i].weight; }

  [[nodiscard]] const gonio::aperture& aperture(Eigen::Index i) const noexcept { return rows_[i].aperture; }
  /// Returns true if one of the measurements is a mean over cones of directions.
  [[nodiscard]] bool have_apertures() const noexcept {
    return std::ranges::any_of(rows_, [](const sample& each) { return !each.aperture.is_point(); });
  }
  /// Returns the same values, all with this aperture.
  [[nodiscard]] sample_set through(const gonio::aperture& aperture) const;

  /// Returns some of the measurements, by their positions.
  [[nodiscard]] sample_set subset(std::span<const Eigen::Index> positions) const;
  /// Returns one channel of the measurements.
  [[nodiscard]] sample_set channel(Eigen::Index c) const;
  /// Returns the same measurements with wavelengths seen under another light.
  [[nodiscard]] sample_set under(illuminant light) const;
  /// Returns the measurements as linear Rec. 709 under their light; one channel becomes grey. Throws gonio::error if
  /// none of several wavelengths is visible.
  [[nodiscard]] sample_set colours() const;
  /// Returns the measurements in three channels for computing, not for display: see `channels::three`.
  [[nodiscard]] sample_set in_three_channels() const;

  // ---- access as a sequence; throws gonio::error for several wavelengths ----

  [[nodiscard]] iterator begin() { return samples().begin(); }
  [[nodiscard]] iterator end() { return rows_.end(); }
  [[nodiscard]] const_iterator begin() const { return samples().begin(); }
  [[nodiscard]] const_iterator end() const { return rows_.end(); }
  [[nodiscard]] sample& operator[](std::size_t i) { return samples()[i]; }
  [[nodiscard]] const sample& operator[](std::size_t i) const { return samples()[i]; }
  [[nodiscard]] sample& front() { return samples().front(); }
  [[nodiscard]] const sample& front() const { return samples().front(); }
  [[nodiscard]] sample& back() { return samples().back(); }
  [[nodiscard]] const sample& back() const { return samples().back(); }
  void push_back(const sample& one) { samples().push_back(one); }
  template <std::input_iterator Iterator>
  void insert(const_iterator before, Iterator first, Iterator last) {
    samples().insert(before, first, last);
  }
  void insert(const_iterator before, std::size_t count, const sample& each) { samples().insert(before, count, each); }
  void erase(const_iterator one) { samples().erase(one); }

 private:
  [[nodiscard]] const std::vector<sample>& samples() const {
    if (channels_.are_wavelengths()) refuse_wavelengths();
    return rows_;
  }
  [[nodiscard]] std::vector<sample>& samples() {
    if (channels_.are_wavelengths()) refuse_wavelengths();
    return rows_;
  }
  [[noreturn]] void refuse_wavelengths() const;
  /// Returns the same measurements with other values.
  [[nodiscard]] sample_set with_values(gonio::channels kinds, const std::function<rgb(Eigen::Index)>& value) const;

  gonio::channels channels_;
  std::vector<sample> rows_;
  std::vector<double> spectra_;  ///< values at several wavelengths, samples x channels; `rows_` then has zeros
};
static_assert(sample_range<sample_set>);

/// Throws gonio::error if there is no sample. Also throws, naming the first such sample, if a number is not finite or
/// outside the range of float, a weight is negative, a half angle is out of range, or a direction is at or below the
/// horizon.
void require_usable(const sample_set& samples);

/// Returns the positions of the measurements that have a positive weight in any channel. Estimators use only these.
[[nodiscard]] std::vector<Eigen::Index> counting_positions(const sample_set& samples);

/// Returns true if the weight of any measurement differs between channels. Takes samples, or any type with a `weight`
/// of type `channel_weights`.
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
