#pragma once
/// Bodies of capture/calibration.hpp.

#include <gonio/capture/calibration.hpp>
#include <gonio/capture/high_dynamic_range.hpp>
#include <gonio/capture/reference_reflectance.hpp>
#include <gonio/capture/relative_reflectance.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::capture::detail {

GONIO_INLINE std::vector<double> times_in_common(std::span<const reading> readings) {
  std::vector<double> times = readings.front().times;
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::erase_if(times, [&](double time) {
    return std::ranges::any_of(readings, [&](const reading& each) { return !std::ranges::count(each.times, time); });
  });
  return times;
}

GONIO_INLINE exposure_counts mean_counts(std::span<const reading> readings, std::span<const double> times,
                                         Eigen::Index channel, std::uint16_t largest_count) {
  exposure_counts counts(std::ssize(readings), std::ssize(times));
  for (Eigen::Index i = 0; i < counts.rows(); ++i) {
    const reading& each = readings[i];
    for (Eigen::Index j = 0; j < counts.cols(); ++j) {
      const auto at = std::ranges::find(each.times, times[j]) - each.times.begin();
      const auto pixels = each.frames[at].col(channel);
      counts(i, j) = pixels.maxCoeff() >= largest_count ? largest_count : pixels.cast<double>().mean();
    }
  }
  return counts;
}

GONIO_INLINE measured_radiance radiance_of(const reading& taken, Eigen::Index channel, const calibration& known) {
  return merge_exposures(taken, channel, known.responses[static_cast<std::size_t>(channel)], known.noise,
                         known.saturation);
}

/// Returns f of a material in each channel, from the lamp's strength in that channel.
GONIO_INLINE measured_reflectance reflectance_under(const std::array<std::optional<reference_light>, 3>& lights,
                                                    const reading& material, const direction_pair& at,
                                                    const illumination& material_at, const calibration& known) {
  measured_reflectance result{at};
  bool is_dark = true;
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    const measured_radiance seen = radiance_of(material, channel, known);
    if (seen.saturated) {
      result.doubt = "saturated in every exposure";
      return result;
    }
    const uncertain f = lights[static_cast<std::size_t>(channel)]->brdf({seen.value, seen.deviation}, material_at);
    result.value[channel] = f.value;
    result.deviation[channel] = f.deviation;
    is_dark = is_dark && seen.dark;
  }
  if (is_dark) result.doubt = "dark in every exposure";
  return result;
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE std::array<camera_response, 3> estimate_responses(std::span<const reading> readings,
                                                               std::uint16_t largest_count,
                                                               const response_options& options) {
  if (readings.empty()) refuse("a camera's response needs at least one reading");
  const std::vector<double> times = detail::times_in_common(readings);
  if (times.size() < 2)
    refuse("a camera's response needs readings with at least two common exposure times, not " +
           std::to_string(times.size()));
  const auto response_of = [&](Eigen::Index channel) {
    return estimate_response(detail::mean_counts(readings, times, channel, largest_count), times, largest_count,
                             options);
  };
  return {response_of(0), response_of(1), response_of(2)};
}

GONIO_INLINE double measured_reflectance::relative_deviation() const noexcept {
  return deviation.matrix().norm() / std::max(value.sum(), 0.0);
}

GONIO_INLINE channel_weights measured_reflectance::weights() const {
  // Metrics add this offset before they take a logarithm. It limits the effect of noise where the material is black.
  constexpr double offset = 0.001;
  rgb of_each;
  for (Eigen::Index channel = 0; channel < 3; ++channel)
    of_each[channel] = weight_of(deviation[channel] / (std::max(value[channel], 0.0) + offset));
  return of_each;
}

GONIO_INLINE measured_reflectance measure_reflectance(const reading& material, const reading& reference,
                                                      const direction_pair& at, const calibration& known,
                                                      const illumination& material_at, const illumination& reference_at,
                                                      const std::optional<direction_pair>& reference_pose) {
  const rgb factor = known.reflectance.at(reference_pose.value_or(at));
  std::array<std::optional<reference_light>, 3> lights;
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    const measured_radiance white = detail::radiance_of(reference, channel, known);
    if (!white.usable()) {
      measured_reflectance none{at};
      none.doubt = std::string("the reference is ") + (white.dark ? "dark" : "saturated");
      return none;
    }
    // Compute f as if the reference were a perfect diffuser, and correct it by `factor`.
    lights[static_cast<std::size_t>(channel)] = reference_light({white.value, white.deviation}, 1.0, reference_at);
  }
  measured_reflectance result = detail::reflectance_under(lights, material, at, material_at, known);
  result.value *= factor;
  result.deviation *= factor;
  return result;
}

GONIO_INLINE std::array<uncertain, 3> mean_exposures(std::span<const reading> readings, const calibration& known) {
  if (readings.empty()) refuse("a mean exposure needs at least one reading");
  const auto count = static_cast<double>(readings.size());
  std::array<uncertain, 3> means;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    double variances = 0.0;
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const measured_radiance seen = detail::radiance_of(readings[i], static_cast<Eigen::Index>(channel), known);
      if (!seen.usable()) refuse({"reading ", i + 1, " is ", seen.dark ? "dark" : "saturated", " in every exposure"});
      means[channel].value += seen.value / count;
      variances += seen.deviation * seen.deviation;
    }
    means[channel].deviation = std::sqrt(variances) / count;
  }
  return means;
}

GONIO_INLINE measured_reflectance measure_reflectance(const reading& material, const measured_lamp& lamp,
                                                      const direction_pair& at, const calibration& known) {
  std::array<std::optional<reference_light>, 3> lights;
  for (std::size_t channel = 0; channel < 3; ++channel)
    lights[channel] = reference_light::of_lamp(lamp.exposures[channel], lamp.solid_angle, lamp.transmittance);
  return detail::reflectance_under(lights, material, at, {.cosine = at.wi.z()}, known);
}

GONIO_INLINE reference_readings::reference_readings(std::vector<direction_pair> poses, std::vector<reading> readings)
    : poses_(std::move(poses)), readings_(std::move(readings)) {
  if (readings_.empty()) refuse("a reference needs at least one reading");
  if (readings_.size() != poses_.size())
    refuse({"a reference has ", readings_.size(), " readings at ", poses_.size(), " poses, expected one at each"});
}

GONIO_INLINE measured_reflectance reference_readings::measure(const reading& material, const direction_pair& at,
                                                              const calibration& known) const {
  const auto nearest =
      std::ranges::min_element(poses_, {}, [&](const direction_pair& pose) { return angle_between(pose.wi, at.wi); });
  const reading& white = readings_[nearest - poses_.begin()];
  return measure_reflectance(material, white, at, known, {.cosine = at.wi.z()}, {.cosine = nearest->wi.z()}, *nearest);
}

GONIO_INLINE void require_bright_reference(std::span<const measured_reflectance> usable,
                                           const reference_reflectance& reflectance) {
  constexpr double margin = 1.05;
  Eigen::Index darker = 0, matte = 0, darker_matte = 0;
  for (const measured_reflectance& each : usable) {
    const bool is_darker = each.value.mean() > margin * reflectance.largest() * std::numbers::inv_pi;
    const bool is_matte = to_half_difference(each.at.wi, each.at.wo).theta_h > radians(10.0);
    darker += is_darker ? 1 : 0;
    matte += is_matte ? 1 : 0;
    darker_matte += is_darker && is_matte ? 1 : 0;
  }
  if (2 * darker > std::ssize(usable))
    refuse({"the reference is darker than the material in ", darker, " of ", usable.size(),
            " samples: are the two swapped?"});
  if (2 * darker_matte > matte)
    refuse({"the reference is darker than the material in ", darker_matte, " of the ", matte,
            " samples outside the highlight: are the two swapped?"});
}

}  // namespace gonio::capture
