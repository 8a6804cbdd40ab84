#pragma once
/// Converts readings of a material and of a white reference, or of the lamp, to BRDF samples with uncertainties
/// (Nielsen's thesis 2016, note on relative BRDF measurement, Sec. 1, 3 and 4).

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

/// The calibration of a camera and of its white reference.
struct calibration {
  std::array<camera_response, 3> responses;  ///< red, green, blue
  sensor_noise noise = {};
  reference_reflectance reflectance = 0.99;  ///< of Spectralon
  std::uint16_t saturation = 0;  ///< pixels are saturated from this count on; 0 stands for the largest count
};

namespace detail {

/// Returns the exposure times that occur in all readings, each once.
[[nodiscard]] std::vector<double> times_in_common(std::span<const reading> readings);

/// Returns, for each reading and time, the mean count over the pixels of the reading. If a pixel is saturated, returns
/// the largest count instead. Single pixels would bias the response, because noise gives a pixel's brighter exposures
/// more weight than its darker ones.
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
  std::string doubt{};  ///< why the value cannot be used; empty if it can

  [[nodiscard]] bool is_usable() const noexcept { return doubt.empty(); }

  /// Returns the relative standard deviation of the sum of the channels. A single black channel may be less certain.
  [[nodiscard]] double relative_deviation() const noexcept;

  /// Returns the weight of each channel, given its standard deviation in the logarithm that estimators compare.
  [[nodiscard]] channel_weights weights() const;

  /// Returns the sample for estimators, with the weights of `weights()`. Call it only for usable values.
  [[nodiscard]] sample as_sample() const { return {at, value, weights()}; }
};

/// Returns the BRDF of a material from a reading of the material and a reading of the reference at the same pair of
/// directions (Eq. 18). Uses the mean radiance over all pixels. A channel that is dark in every exposure has the value
/// 0. `material_at` and `reference_at` are the positions of material and reference in the light, if they differ (Eq.
/// 22).
///
/// Looks up the reference's reflectance at the pair `at`. If the reference's normal differs from the material's, give
/// the pair relative to the reference's normal as `reference_pose`.
///
/// Throws gonio::error as merge_exposures, reference_reflectance::at, reference_light and reference_light::brdf do.
[[nodiscard]] measured_reflectance measure_reflectance(const reading& material, const reading& reference,
                                                       const direction_pair& at, const calibration& known,
                                                       const illumination& material_at = {},
                                                       const illumination& reference_at = {},
                                                       const std::optional<direction_pair>& reference_pose = {});

/// A lamp as seen by the camera, which looks into it: the absolute method (Sec. 1).
struct measured_lamp {
  std::array<uncertain, 3> exposures;  ///< per second, of each channel; through the filter
  double solid_angle = 0.0;            ///< of the lamp, seen from the sample, in sr
  double transmittance = 1.0;          ///< of the filter
};

/// Returns the mean exposure per second of each channel over some readings, with the deviation of the mean. Throws
/// gonio::error if there is no reading, or if one of them is dark or saturated in every exposure.
[[nodiscard]] std::array<uncertain, 3> mean_exposures(std::span<const reading> readings, const calibration& known);

/// Returns the BRDF of a material from a reading of the material and from the lamp: f = X / (X_lamp Omega
/// cos(theta_i)). Needs no reference; ignores `known.reflectance`. Throws gonio::error as merge_exposures,
/// reference_light::of_lamp and reference_light::brdf do.
[[nodiscard]] measured_reflectance measure_reflectance(const reading& material, const measured_lamp& lamp,
                                                       const direction_pair& at, const calibration& known);

/// Readings of a white reference, for use at poses where it was not measured. Assumes that the reference is matte and
/// at the material's position: its radiance is proportional to the cosine of incidence and equal for every viewer (Eq.
/// 21 and 22), except for the factor of its reflectance table at the pose of its reading. A pose of the material uses
/// the reading of the reference with the nearest light direction, so that each lamp of an arc is compared with itself.
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

/// Throws gonio::error if the reference appears to be exchanged with the material: if the material is more than 5 %
/// brighter than the reference would be with its largest factor, in most samples or in most samples whose half vector
/// is more than 10 degrees from the normal. Rejects a correct measurement only if it contains little but a highlight,
/// or if the material is whiter than the reference.
void require_bright_reference(std::span<const measured_reflectance> usable, const reference_reflectance& reflectance);

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/calibration.ipp>
#endif
