#pragma once
/// Samples out of the tables of other programs: what the numbers of a direction are, and which directions count.

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>
#include <gonio/table/spectral_samples.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// What a file has for each pair of directions, and the linear Rec. 709 colour that it makes.
class colour_channels {
 public:
  [[nodiscard]] static colour_channels grey() { return {kind::grey, 1}; }
  [[nodiscard]] static colour_channels linear_rgb() { return {kind::rgb, 3}; }
  /// CIE XYZ under D65, Y of a perfect diffuser being 1 / pi.
  [[nodiscard]] static colour_channels xyz() { return {kind::xyz, 3}; }
  /// Wavelengths in nanometres; a single one is grey. Throws gonio::error unless they are ascending.
  [[nodiscard]] static colour_channels spectrum(std::span<const double> wavelengths);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// Nanometres; none if the channels are no spectrum.
  [[nodiscard]] const std::vector<double>& wavelengths() const noexcept { return wavelengths_; }
  /// Do the channels make a colour? Those of a spectrum do if two are visible, or if there is one.
  [[nodiscard]] bool have_colour() const noexcept { return kind_ != kind::spectrum || colour_.has_value(); }
  /// Of as many values as there are channels; needs `have_colour`.
  [[nodiscard]] rgb operator()(std::span<const double> values) const;

 private:
  enum class kind { grey, rgb, xyz, spectrum };
  colour_channels(kind what, std::size_t size) : kind_(what), size_(size) {}

  kind kind_;
  std::size_t size_;
  std::vector<double> wavelengths_;
  std::optional<spectral_colour> colour_;
};

/// Refuses a reflectance that no float holds.
void require_float_range(double reflectance, const text_place& place);

/// Is the direction above the horizon by more than the rounding of angles? Tables go to 90 degrees, where nothing can
/// be measured, and those about the specular direction go on below.
[[nodiscard]] inline bool is_above_horizon(const direction& w) noexcept { return w.z() > 1e-6; }

/// Which of azimuths, in degrees, are not the same as one before, or a turn apart. O(n log n).
[[nodiscard]] std::vector<bool> are_new_azimuths(std::span<const double> azimuths);

/// Collects samples, but those at or below the horizon: their colours, and the spectra that these were made of.
class sample_collector {
 public:
  explicit sample_collector(colour_channels channels = colour_channels::grey()) : channels_(std::move(channels)) {}

  /// The samples that follow are spectra at these wavelengths. Throws as `colour_channels::spectrum`.
  void use_wavelengths(std::span<const double> wavelengths);

  /// Of as many values as there are channels.
  void add(const direction_pair& pair, std::span<const double> values, double weight = 1.0);

  /// Throws gonio::error naming the file if there is no sample, or one of an invisible spectrum.
  [[nodiscard]] sample_set samples(const std::string& name) &&;

  /// Throws gonio::error naming the file if there is no sample, or one that has no spectrum or other wavelengths.
  [[nodiscard]] spectral_samples spectra(const std::string& name) &&;

 private:
  void require_samples(const std::string& name) const;

  colour_channels channels_;
  bool have_colours_ = true, share_wavelengths_ = true;
  sample_set samples_;
  std::vector<float> spectra_;
};

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_collector.ipp>
#endif
