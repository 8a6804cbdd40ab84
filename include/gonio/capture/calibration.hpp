#pragma once
/// Readings of a material and of a white reference as samples of the BRDF, each with its uncertainty (Nielsen's thesis
/// 2016, note on relative BRDF measurement, Sec. 3 and 4).

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

/// What is known of a camera and of the white reference.
struct calibration {
  std::array<camera_response, 3> responses;  ///< of red, green and blue
  sensor_noise noise = {};
  reference_reflectance reflectance = 0.99;  ///< Spectralon's
  std::uint16_t saturation = 0;  ///< from this count on a pixel is saturated; 0 stands for the largest count
};

namespace detail {

/// The exposure times that all readings have, each once.
[[nodiscard]] std::vector<double> times_in_common(std::span<const reading> readings);

/// The mean count of each reading's pixels at these times, or the largest if a pixel is saturated: their noise would
/// weigh a pixel's brighter exposures more than its darker ones.
[[nodiscard]] exposure_counts mean_counts(std::span<const reading> readings, std::span<const double> times,
                                          Eigen::Index channel, std::uint16_t largest_count);

}  // namespace detail

/// The responses of a camera's three channels from readings of anything that does not move meanwhile: of each, the
/// mean over the pixels at the times that all readings have.
///
/// Throws gonio::error if there is no reading, if they have less than two times in common, or as estimate_response
/// does.
[[nodiscard]] std::array<camera_response, 3> estimate_responses(std::span<const reading> readings,
                                                                std::uint16_t largest_count,
                                                                const response_options& options = {});

/// A BRDF's value in sr^-1 at a pair of directions, with the standard deviation of each channel.
struct measured_reflectance {
  direction_pair at;
  rgb value = rgb::Zero(), deviation = rgb::Zero();
  std::string doubt{};  ///< why the value means nothing; empty if it means something

  [[nodiscard]] bool is_usable() const noexcept { return doubt.empty(); }

  /// Of the sum of the channels: a colour in which the material is black need not be known well.
  [[nodiscard]] double relative_deviation() const noexcept;

  /// How much each channel counts, by what its deviation does to the logarithm that estimators compare.
  [[nodiscard]] channel_weights weights() const;

  /// The sample that estimators take, with these weights. Not for values that mean nothing.
  [[nodiscard]] sample as_sample() const { return {at, value, weights()}; }
};

/// The BRDF of a material from a reading of it and one of the reference at the same pair of directions (Eq. 18), by
/// the radiances of all pixels on average. A channel that is dark in every exposure has the value 0. `illumination`
/// says where the surfaces lay, if not in the same place (Eq. 22).
///
/// The reference's reflectance is that at the same pair: where its normal is another, a table needs the pair as the
/// reference sees it, in `reference_pose`.
///
/// Throws gonio::error as merge_exposures, reference_reflectance::at, reference_light and reference_light::brdf do.
[[nodiscard]] measured_reflectance measure_reflectance(const reading& material, const reading& reference,
                                                       const direction_pair& at, const calibration& known,
                                                       const illumination& material_at = {},
                                                       const illumination& reference_at = {},
                                                       const std::optional<direction_pair>& reference_pose = {});

/// Readings of a white reference that serve poses at which it was not measured. The reference is matte and lies where
/// the material does: its radiance falls as the cosine of incidence and is the same for every viewer (Eq. 21 and 22),
/// but for what a table of its reflectance says of the pose of the reading. A pose takes the reading whose light is
/// nearest to its own, so that a lamp of an arc is compared with itself.
class reference_readings {
 public:
  /// Throws gonio::error if there is no reading, or not one for each pose.
  reference_readings(std::vector<direction_pair> poses, std::vector<reading> readings);

  /// As `measure_reflectance`. O(number of readings).
  [[nodiscard]] measured_reflectance measure(const reading& material, const direction_pair& at,
                                             const calibration& known) const;

 private:
  std::vector<direction_pair> poses_;
  std::vector<reading> readings_;
};

/// Throws gonio::error if the reference is darker than the material, by over 5 % of the largest of its factors, in most
/// samples, or in most of those whose half vector is over 10 degrees from the normal: the two were exchanged. It is
/// right only where nothing but a highlight was measured, or what is whiter than the reference.
void require_bright_reference(std::span<const measured_reflectance> usable, const reference_reflectance& reflectance);

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/calibration.ipp>
#endif
