#pragma once
/// Measurements of a spectrum in each pair of directions: what a spectral gonioreflectometer hands in.

#include <gonio/core/spectrum.hpp>
#include <gonio/core/wavelengths.hpp>
#include <gonio/table/cell_matrix.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <span>
#include <vector>

namespace gonio {

/// n measurements at w wavelengths. A laser's file has one wavelength.
struct spectral_samples {
  std::vector<double> wavelengths;            ///< nanometres, ascending; w of them
  std::vector<sample_directions> directions;  ///< n
  cell_matrix values;                         ///< n x w, sr^-1, without the cosine; may be negative
  std::vector<double> weights = {};           ///< how much each measurement counts, n; all 1 if empty

  /// The number of measurements.
  [[nodiscard]] Eigen::Index size() const noexcept { return std::ssize(directions); }
  /// The number of wavelengths.
  [[nodiscard]] Eigen::Index bands() const noexcept { return std::ssize(wavelengths); }
  [[nodiscard]] double weight(Eigen::Index i) const noexcept { return weights.empty() ? 1.0 : weights[i]; }
  /// The w reflectances of a measurement.
  [[nodiscard]] std::span<const float> spectrum(Eigen::Index i) const noexcept {
    return {values.data() + i * values.cols(), static_cast<std::size_t>(values.cols())};
  }

  /// The measurements at one wavelength, the same in all three channels.
  [[nodiscard]] sample_set at_wavelength(Eigen::Index band) const;

  /// The measurements as linear Rec. 709 under an illuminant (`spectral_colour`); those of one wavelength are grey.
  /// Throws gonio::error if none of several wavelengths is visible.
  [[nodiscard]] sample_set colours(illuminant light = illuminant::d65) const;

  /// The measurements in three channels, for whoever looks at three: their colours or, where none of several
  /// wavelengths is visible, the means of the lower, the middle and the upper third of the wavelengths.
  [[nodiscard]] sample_set in_three_channels(illuminant light = illuminant::d65) const;

  /// Some of the measurements, by their positions.
  [[nodiscard]] spectral_samples subset(std::span<const Eigen::Index> positions) const;
};

/// Refuses what no estimator can use: throws gonio::error for wavelengths that are none, for sizes that do not match,
/// and naming the first sample that `require_usable` of a `sample_set` would refuse.
void require_usable(const spectral_samples& samples);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/spectral_samples.ipp>
#endif
