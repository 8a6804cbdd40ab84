#pragma once
/// Converts readings of a material and of a white reference to BRDF samples with uncertainties (Nielsen's thesis 2016,
/// note on relative BRDF measurement, Sec. 3 and 4).

#include <gonio/capture/high_dynamic_range.hpp>
#include <gonio/capture/reference_reflectance.hpp>
#include <gonio/capture/relative_reflectance.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/table/sample_set.hpp>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gonio::capture {

/// The calibration of a camera and of the white reference.
struct calibration {
  std::array<camera_response, 3> responses;  ///< red, green, blue
  sensor_noise noise = {};
  reference_reflectance reflectance = 0.99;  ///< of Spectralon
  std::uint16_t saturation = 0;  ///< pixels are saturated from this count on; 0 stands for the largest count
};

namespace detail {

/// Returns the exposure times that all readings have, each once.
[[nodiscard]] std::vector<double> times_in_common(std::span<const reading> readings);

/// Returns the mean count of each reading's pixels at these times. If a pixel is saturated, returns the largest count
/// for that reading and time. Single pixels would bias the response: noise gives a pixel's brighter exposures more
/// weight than its darker ones.
[[nodiscard]] exposure_counts mean_counts(std::span<const reading> readings, std::span<const double> times,
                                          Eigen::Index channel, std::uint16_t largest_count);

}  // namespace detail

/// Estimates the responses of a camera's three channels from readings of a static scene. Uses, for each reading, the
/// mean over its pixels at the times common to all readings.
///
/// Throws gonio::error if there is no reading, if fewer than two times are common to all, or as estimate_response does.
[[nodiscard]] std::array<camera_response, 3> estimate_responses(std::span<const reading> readings,
                                                                std::uint16_t largest_count,
                                                                const response_options& options = {});

/// A BRDF's value in sr^-1 at a pair of directions, with the standard deviation of each channel.
struct measured_reflectance {
  direction_pair at;
  rgb value = rgb::Zero(), deviation = rgb::Zero();
  std::string doubt{};  ///< why the value is unusable; empty if it is usable

  [[nodiscard]] bool is_usable() const noexcept { return doubt.empty(); }

  /// Returns the relative deviation of the sum of the channels. A channel may be uncertain if it is black.
  [[nodiscard]] double relative_deviation() const noexcept;

  /// Returns the weight of each channel, from the effect of its deviation on the logarithm that estimators compare.
  [[nodiscard]] channel_weights weights() const;

  /// Returns the sample for estimators, with these weights. Call it only for usable values.
  [[nodiscard]] sample as_sample() const { return {at, value, weights()}; }
};

/// Returns the BRDF of a material from a reading of it and one of the reference at the same pair of directions (Eq.
/// 18), by the mean radiance over all pixels. A channel that is dark in every exposure has the value 0. `illumination`
/// gives the position of each surface in the light if they differ (Eq. 22).
///
/// The reference's reflectance is taken at the same pair. If the reference's normal differs from the material's, a
/// reflectance table needs the pair relative to the reference, in `reference_pose`.
///
/// Throws gonio::error as merge_exposures, reference_reflectance::at, reference_light and reference_light::brdf do.
[[nodiscard]] measured_reflectance measure_reflectance(const reading& material, const reading& reference,
                                                       const direction_pair& at, const calibration& known,
                                                       const illumination& material_at = {},
                                                       const illumination& reference_at = {},
                                                       const std::optional<direction_pair>& reference_pose = {});

/// Readings of a white reference, for use at poses where it was not measured. The reference is matte and in the
/// material's place: its radiance is proportional to the cosine of incidence and equal for every viewer (Eq. 21 and
/// 22), apart from its reflectance table at the reading's pose. A pose uses the reading with the nearest light
/// direction, so that each lamp of an arc is compared with itself.
class reference_readings {
 public:
  /// Throws gonio::error if there is no reading, or if the number of poses differs.
  reference_readings(std::vector<direction_pair> poses, std::vector<reading> readings);

  /// Like `measure_reflectance`, with the nearest reference reading. O(number of readings).
  [[nodiscard]] measured_reflectance measure(const reading& material, const direction_pair& at,
                                             const calibration& known) const;

 private:
  std::vector<direction_pair> poses_;
  std::vector<reading> readings_;
};

/// Throws gonio::error if the reference appears to be exchanged with the material: it is more than 5 % darker than the
/// material, relative to the largest of its factors, in most samples, or in most samples whose half vector is more than
/// 10 degrees from the normal. Rejects a correct measurement only if it has nothing but a highlight, or if the material
/// is whiter than the reference.
void require_bright_reference(std::span<const measured_reflectance> usable, const reference_reflectance& reflectance);

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/calibration.ipp>
#endif
