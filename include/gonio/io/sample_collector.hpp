#pragma once
/// Samples out of the tables of other programs: what the numbers of a direction are, and which directions count.

#include <gonio/core/direction.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/io/text.hpp>
#include <gonio/table/sample_set.hpp>

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
  /// Wavelengths in nanometres, ascending; a single one is grey. Throws gonio::error unless two are visible.
  [[nodiscard]] static colour_channels spectrum(std::span<const double> wavelengths);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// Of as many values as there are channels.
  [[nodiscard]] rgb operator()(std::span<const double> values) const;

 private:
  enum class kind { grey, rgb, xyz, spectrum };
  colour_channels(kind what, std::size_t size) : kind_(what), size_(size) {}

  kind kind_;
  std::size_t size_;
  std::optional<spectral_colour> colour_;
};

/// Refuses a reflectance that no float holds.
void require_float_range(double reflectance, const text_place& place);

/// Is the direction above the horizon by more than the rounding of angles? Tables go to 90 degrees, where nothing can
/// be measured, and those about the specular direction go on below.
[[nodiscard]] inline bool is_above_horizon(const direction& w) noexcept { return w.z() > 1e-6; }

/// Which of azimuths, in degrees, are not the same as one before, or a turn apart. O(n log n).
[[nodiscard]] std::vector<bool> are_new_azimuths(std::span<const double> azimuths);

/// Collects samples, but those at or below the horizon.
class sample_collector {
 public:
  void add(const direction_pair& pair, const rgb& value, double weight = 1.0);

  /// Throws gonio::error naming the file if there is no sample.
  [[nodiscard]] sample_set take(const std::string& name) &&;

 private:
  sample_set samples_;
};

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/sample_collector.ipp>
#endif
