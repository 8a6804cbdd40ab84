#pragma once
/// Bodies of capture/merged_frames.hpp.

#include <gonio/capture/merged_frames.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/probability.hpp>
#include <gonio/core/random.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace gonio::capture::detail {

/// A response as a table. Converts counts above the dark level to the counts of a linear camera with the same range.
class linear_counts {
 public:
  linear_counts(const camera_response& response, std::uint16_t largest, double level)
      : level_(level), scale_(response.largest_count() / response.exposure(response.largest_count())) {
    linear_.resize(largest + 1);
    rounding_.resize(largest + 1);
    const double unit = scale_ * response.exposure(1.0);
    for (Eigen::Index count = 0; count <= largest; ++count) {
      const double above = static_cast<double>(count) - level;
      // Below one count, continue along a line through 0, because noise also gives counts below the dark level.
      linear_[count] = above > 1.0 ? scale_ * response.exposure(above) : unit * above;
      const double slope = above > 1.0 ? linear_[count] * response.slope(above) : unit;
      rounding_[count] = slope * slope / 12.0;
    }
    const double spacing = response.largest_count() / static_cast<double>(response.log_exposures().size());
    if (response.smallest_known_count() > spacing) first_known_ = level + response.smallest_known_count();
  }

  [[nodiscard]] double operator()(std::uint16_t count) const noexcept { return linear_[count]; }
  /// Returns the linear count of a count that may be fractional, by interpolation.
  [[nodiscard]] double between(double count) const noexcept {
    const auto last = std::ssize(linear_) - 1;
    const auto left = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor(count)), 0, last - 1);
    return linear_[left] + (count - static_cast<double>(left)) * (linear_[left + 1] - linear_[left]);
  }
  /// Returns the variance of the linear count that is due to rounding to whole counts.
  [[nodiscard]] double rounding(std::uint16_t count) const noexcept { return rounding_[count]; }
  /// Returns true if the response is extrapolated at this count.
  [[nodiscard]] bool is_guess(std::uint16_t count) const noexcept { return count < first_known_; }
  /// Returns the linear counts per unit of exposure.
  [[nodiscard]] double scale() const noexcept { return scale_; }
  [[nodiscard]] double level() const noexcept { return level_; }

 private:
  double level_, scale_, first_known_ = 0.0;
  std::vector<double> linear_, rounding_;
};

/// One exposure of a value, in linear counts.
struct said_by_exposure {
  double time = 0.0;
  double signal = 0.0;    ///< linear counts minus the dark signal
  double dark = 0.0;      ///< dark signal above the dark level
  double variance = 0.0;  ///< variance of the parts that do not depend on light
  bool is_guess = false;
};

/// The weighted mean of several exposures, in linear counts per second.
struct mean_of_exposures {
  double value = 0.0, weights = 0.0, chi_square = 0.0;
  Eigen::Index used = 0;
};

/// Merges the exposures of one value at a time.
class value_merger {
 public:
  value_merger(const sensor_noise& noise, double lowest, double highest) noexcept
      : noise_(noise), lowest_(lowest), highest_(highest) {}

  void clear() noexcept { said_.clear(); }
  void add(const said_by_exposure& said) { said_.push_back(said); }
  [[nodiscard]] bool has_none() const noexcept { return said_.empty(); }

  [[nodiscard]] mean_of_exposures mean() const {
    const bool only_guesses = std::ranges::all_of(said_, &said_by_exposure::is_guess);
    // Start with the variances at the measured counts. The next rounds use the variances at the predicted counts.
    mean_of_exposures found =
        pass([&](const said_by_exposure& each) { return each.signal; },
             [&](const said_by_exposure& each, double) { return only_guesses || !each.is_guess; });
    for (int round = 0; round < 2; ++round) {
      const auto predicted = [rate = found.value](const said_by_exposure& each) { return rate * each.time; };
      const auto is_within = [&](const said_by_exposure& each, double variance) {
        constexpr double deviations = 2.0;
        const double reach = deviations * std::sqrt(variance), total = predicted(each) + each.dark;
        return (only_guesses || !each.is_guess) && total - reach > lowest_ && total + reach < highest_;
      };
      const mean_of_exposures better = pass(predicted, is_within);
      found = better.used > 0 ? better : pass(predicted, [](const said_by_exposure&, double) { return true; });
    }
    return found;
  }

 private:
  /// Averages the exposures for which `wanted` returns true, with the variances of the signals that `expected` returns.
  template <class Expected, class Wanted>
  [[nodiscard]] mean_of_exposures pass(const Expected& expected, const Wanted& wanted) const {
    double sum = 0.0, squares = 0.0;
    mean_of_exposures result;
    for (const said_by_exposure& each : said_) {
      const double signal = std::max(expected(each), 0.0);
      const double variance = each.variance + noise_.read * noise_.read +
                              noise_.shot * std::max(signal + each.dark, 0.0) + std::pow(noise_.relative * signal, 2);
      if (!wanted(each, variance)) continue;
      result.weights += each.time * each.time / variance;
      sum += each.time * each.signal / variance;
      squares += each.signal * each.signal / variance;
      ++result.used;
    }
    if (!(result.weights > 0.0)) return {};
    result.value = sum / result.weights;
    result.chi_square = std::max(squares - sum * result.value, 0.0);
    return result;
  }

  sensor_noise noise_;
  double lowest_, highest_;  ///< range of valid linear counts above the dark level
  std::vector<said_by_exposure> said_;
};

/// The inputs of merging, and limits that are the same for all values.
class frame_merger {
 public:
  frame_merger(std::span<const exposed_frame> frames, const std::array<camera_response, 3>& responses,
               const dark_signal& dark, const merge_options& options)
      : frames_(frames), dark_(dark), options_(options), first_(frames.front().codes) {
    const double level = first_.largest - counts_above(first_.largest, dark);
    for (const camera_response& each : responses) tables_.emplace_back(each, first_.largest, level);
    limit_ = options.saturation > 0 ? options.saturation : first_.largest;
    // Compute limits of chi-square that chance exceeds for one value in a million.
    for (Eigen::Index used = 2; used <= std::ssize(frames); ++used)
      most_chi_square_.push_back(chi_square_quantile(1.0 - 1e-6, static_cast<double>(used - 1)));
    shortest_ = std::ranges::min(frames, {}, &exposed_frame::seconds).seconds;
    longest_ = std::ranges::max(frames, {}, &exposed_frame::seconds).seconds;
  }

  void merge(block values, merged_frames& into) const {
    std::array<value_merger, 3> mergers{merger_of(0), merger_of(1), merger_of(2)};
    for (Eigen::Index i = values.begin; i < values.end; ++i) {
      const auto channel = static_cast<std::size_t>(i % 3);
      merge_value(i, tables_[channel], mergers[channel], into);
    }
  }

 private:
  [[nodiscard]] value_merger merger_of(std::size_t channel) const {
    const linear_counts& linear = tables_[channel];
    return {options_.noise, linear(0), linear(limit_)};
  }

  void merge_value(Eigen::Index i, const linear_counts& linear, value_merger& merger, merged_frames& into) const {
    // Collect the exposures that are neither saturated nor 0.
    merger.clear();
    bool is_black = true;
    const double read = options_.noise.read;
    for (const auto& [seconds, codes] : frames_) {
      const std::uint16_t count = codes.values[i];
      if (count > 0) is_black = false;
      if (count == 0 || count >= limit_) continue;
      const double dark = linear.between(dark_.count(i, seconds));
      const double of_dark = dark_.relative_variance(seconds) * (read * read + 1.0 / 12.0);
      merger.add({seconds, linear(count) - dark, dark, linear.rounding(count) + of_dark, linear.is_guess(count)});
    }
    // Merge these exposures or, if there are none, determine why.
    double value = 0.0, deviation = std::numeric_limits<double>::infinity();
    value_state state = value_state::usable;
    if (!merger.has_none()) {
      const mean_of_exposures mean = merger.mean();
      value = mean.value;
      deviation = 1.0 / std::sqrt(mean.weights);
      if (value < 2.0 * deviation) state = value_state::dark;
      if (mean.used > 1 && mean.chi_square > most_chi_square_[mean.used - 2]) {
        state = value_state::contradictory;
        deviation *= std::sqrt(mean.chi_square / static_cast<double>(mean.used - 1));
      }
    } else if (is_black) {
      state = value_state::dark;
      deviation = (linear.between(linear.level() + 1.0) + read) / longest_;
    } else {
      state = value_state::saturated;
      value = linear(limit_) / shortest_;
    }
    into.radiance.data()[i] = static_cast<float>(value / linear.scale());
    into.deviation.data()[i] = static_cast<float>(deviation / linear.scale());
    into.states[i] = state;
  }

  std::span<const exposed_frame> frames_;
  const dark_signal& dark_;
  const merge_options& options_;
  const stored_codes& first_;
  std::vector<linear_counts> tables_;
  std::vector<double> most_chi_square_;  ///< limits for two exposures, three, and so on
  std::uint16_t limit_ = 0;
  double shortest_ = 0.0, longest_ = 0.0;
};

GONIO_INLINE void require_mergeable(std::span<const exposed_frame> frames,
                                    const std::array<camera_response, 3>& responses, const dark_signal& dark,
                                    const merge_options& options) {
  require_alike(frames, "a photograph");
  options.noise.require_usable();
  const stored_codes& first = frames.front().codes;
  if (dark.size() > 0 && dark.size() != std::ssize(first.values))
    refuse({"dark frames have ", dark.size() / 3, " pixels, photographs ", first.rows * first.columns});
  for (const exposed_frame& each : frames) dark.require_known(each.seconds);
  const std::uint16_t above = counts_above(first.largest, dark);
  for (const camera_response& each : responses)
    if (each.largest_count() != above)
      refuse({"a response of ", int{each.largest_count()}, " counts does not fit a camera with ", int{above},
              " counts above its dark level"});
  const int limit = options.saturation > 0 ? options.saturation : first.largest;
  if (limit > first.largest || limit <= first.largest - above)
    refuse({"the saturation count is ", limit, ", expected more than the dark level, ", int{first.largest} - above,
            ", and at most the largest count, ", int{first.largest}});
}

/// Groups values of similar radiance, because the mean count of a group has little noise. Noisy counts would bias the
/// response: noise moves a count along the response, and the logarithm of exposure is not linear in the count.
class alike_values {
 public:
  alike_values(std::span<const exposed_frame> frames, std::uint16_t level, std::uint16_t saturation)
      : frames_(frames), level_(level), saturation_(saturation) {}

  /// Returns the mean counts above the dark level of groups of a channel's pixels: one row per group, one column per
  /// frame. If one pixel of a group is saturated in a frame, the whole group counts as saturated there.
  [[nodiscard]] exposure_counts mean_counts(std::span<const Eigen::Index> pixels, Eigen::Index channel) const {
    constexpr Eigen::Index groups_wanted = 400;
    const std::vector<Eigen::Index> values = by_radiance(pixels, channel);
    const Eigen::Index size = std::max<Eigen::Index>(std::ssize(values) / groups_wanted, 1);
    exposure_counts means(std::ssize(values) / size, std::ssize(frames_));
    for (Eigen::Index i = 0; i < means.rows(); ++i)
      for (Eigen::Index j = 0; j < means.cols(); ++j)
        means(i, j) = interquartile_mean(std::span(values).subspan(i * size, size), frames_[j].codes);
    return means;
  }

 private:
  /// Sorts values by the sum of their counts, which increases with radiance for any response.
  [[nodiscard]] std::vector<Eigen::Index> by_radiance(std::span<const Eigen::Index> pixels,
                                                      Eigen::Index channel) const {
    std::vector<std::pair<std::uint64_t, Eigen::Index>> sums;
    sums.reserve(pixels.size());
    for (const Eigen::Index pixel : pixels) {
      const Eigen::Index value = 3 * pixel + channel;
      std::uint64_t sum = 0;
      for (const exposed_frame& each : frames_) sum += each.codes.values[value];
      sums.emplace_back(sum, value);
    }
    std::ranges::sort(sums);
    std::vector<Eigen::Index> values;
    values.reserve(sums.size());
    for (const auto& [sum, value] : sums) values.push_back(value);
    return values;
  }

  /// Returns the mean of the middle half of a group's counts, which ignores hot pixels and pixels that moved.
  [[nodiscard]] double interquartile_mean(std::span<const Eigen::Index> group, const stored_codes& codes) const {
    std::vector<std::uint16_t> counts;
    counts.reserve(group.size());
    for (const Eigen::Index value : group) counts.push_back(codes.values[value]);
    std::ranges::sort(counts);
    if (counts.back() >= saturation_) return codes.largest - level_;
    const auto quarter = std::ssize(counts) / 4;
    const double sum = std::accumulate(counts.begin() + quarter, counts.end() - quarter, 0.0);
    return std::max(sum / static_cast<double>(std::ssize(counts) - 2 * quarter) - level_, 0.0);
  }

  std::span<const exposed_frame> frames_;
  std::uint16_t level_, saturation_;
};

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE value_state merged_frames::pixel_state(Eigen::Index pixel) const noexcept {
  return std::max({states[3 * pixel], states[3 * pixel + 1], states[3 * pixel + 2]});
}

GONIO_INLINE Eigen::Index merged_frames::count(value_state state) const noexcept {
  Eigen::Index number = 0;
  for (Eigen::Index pixel = 0; pixel < std::ssize(states) / 3; ++pixel)
    if (pixel_state(pixel) == state) ++number;
  return number;
}

GONIO_INLINE std::uint16_t counts_above(std::uint16_t largest, const dark_signal& dark) noexcept {
  const double level = std::clamp(std::round(dark.level()), 0.0, largest - 3.0);
  return static_cast<std::uint16_t>(largest - static_cast<int>(level));
}

GONIO_INLINE merged_frames merge_frames(std::span<const exposed_frame> frames,
                                        const std::array<camera_response, 3>& responses, const dark_signal& dark,
                                        const merge_options& options) {
  detail::require_mergeable(frames, responses, dark, options);
  // Merge each value.
  const stored_codes& first = frames.front().codes;
  merged_frames merged{uniform_image(first.rows, first.columns), uniform_image(first.rows, first.columns),
                       std::vector<value_state>(first.values.size())};
  const detail::frame_merger merger(frames, responses, dark, options);
  constexpr Eigen::Index block_size = 3 * 4096;
  for_each_block(
      std::ssize(first.values), block_size, [&](block values) { merger.merge(values, merged); }, options.threads);
  if (std::ranges::all_of(merged.states, [](value_state each) { return each == value_state::saturated; }))
    refuse("every value of every frame is saturated: shorter exposures are needed");
  // Mark hot pixels.
  for (const Eigen::Index pixel : dark.hot_pixels())
    for (Eigen::Index i = 3 * pixel; i < 3 * pixel + 3; ++i) {
      if (merged.states[i] < value_state::hot) merged.states[i] = value_state::hot;
      merged.deviation.data()[i] = std::numeric_limits<float>::infinity();
    }
  return merged;
}

GONIO_INLINE std::array<camera_response, 3> estimate_responses(std::span<const exposed_frame> frames,
                                                               const dark_signal& dark, const response_options& options,
                                                               std::uint64_t seed) {
  detail::require_alike(frames, "a photograph");
  constexpr Eigen::Index pixels_used = 200'000;
  const stored_codes& first = frames.front().codes;
  const std::vector<Eigen::Index> pixels = random_choice(std::ssize(first.values) / 3, pixels_used, seed);
  const std::uint16_t above = counts_above(first.largest, dark), level = first.largest - above;
  const detail::alike_values alike{frames, level, options.saturation > 0 ? options.saturation : first.largest};
  std::vector<double> times;
  for (const exposed_frame& each : frames) times.push_back(each.seconds);
  response_options of_difference = options;
  if (options.saturation > level) of_difference.saturation = options.saturation - level;
  const auto of_channel = [&](Eigen::Index channel) {
    return estimate_response(alike.mean_counts(pixels, channel), times, above, of_difference);
  };
  return {of_channel(0), of_channel(1), of_channel(2)};
}

}  // namespace gonio::capture
