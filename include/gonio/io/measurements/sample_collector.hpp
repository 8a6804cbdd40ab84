#pragma once
/// Common parts of the readers of other programs' tables: checks of numbers and directions, and a collector of samples.

#include <gonio/core/direction.hpp>
#include <gonio/io/text/json_reader.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/aperture.hpp>
#include <gonio/table/channels.hpp>
#include <gonio/table/sample_set.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// Throws gonio::error if the reflectance is outside the range of float.
void require_float_range(double reflectance, const text_position& position);

/// Returns the number. Throws gonio::error with its name unless it is from `lowest` to `highest`.
[[nodiscard]] double require_between(double number, std::string_view name, double lowest, double highest,
                                     const text_position& position);

/// Is the direction above the horizon by more than the rounding of angles? Tables extend to 90 degrees, where nothing
/// can be measured, and tables about the specular direction extend below the horizon.
[[nodiscard]] inline bool is_above_horizon(const direction& w) noexcept { return w.z() > 1e-6; }

/// Returns the half angle of a receiver of a given solid angle in steradians. Throws gonio::error naming the line of
/// `read` if the half angle is not from 0 to the largest one.
[[nodiscard]] double receiver_half_angle(double solid_angle, const json_reader& read);

/// Returns for each azimuth whether it differs, modulo 360 degrees, from all azimuths before it. O(n log n) for n
/// azimuths.
[[nodiscard]] std::vector<bool> are_new_azimuths(std::span<const double> azimuths);

/// Collects samples, except those at or below the horizon.
class sample_collector {
 public:
  explicit sample_collector(channels kinds = channels::one_value()) : kinds_(std::move(kinds)), samples_(kinds_) {}
  /// Returns a collector of CIE XYZ under D65, where a perfect diffuser has Y = 1 / pi.
  [[nodiscard]] static sample_collector of_xyz();

  /// Returns the number of values of a sample.
  [[nodiscard]] std::size_t channel_count() const noexcept { return static_cast<std::size_t>(kinds_.size()); }

  /// Sets the wavelengths of the following samples, in nanometres. If they differ from the earlier ones, all samples
  /// become colours. Throws gonio::error unless they ascend.
  void use_wavelengths(std::span<const double> wavelengths);

  /// Sets the cones of source and receiver for all samples.
  void use_aperture(const aperture& cones) noexcept { aperture_ = cones; }

  /// Adds a sample with one value for each channel.
  void add(const direction_pair& pair, std::span<const double> values, double weight = 1.0);

  /// Returns the samples. Throws gonio::error naming the file if there is none, or if the wavelengths differ between
  /// samples and no wavelength of some sample is visible.
  [[nodiscard]] sample_set samples(const std::string& name) &&;

 private:
  channels kinds_;  ///< channels of the samples to add
  aperture aperture_;
  bool are_xyz_ = false, are_mixed_ = false, have_colours_ = true;
  sample_set samples_;
};

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_collector.ipp>
#endif
