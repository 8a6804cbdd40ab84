#pragma once
/// The channels of measurements and of fits: colours, wavelengths, or one value.

#include <gonio/core/rgb.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/core/wavelengths.hpp>

#include <Eigen/Core>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gonio {

/// The meaning of the numbers that belong to a pair of directions.
///
/// ```cpp
/// const gonio::channels bands({450.0, 550.0, 650.0});
/// const gonio::rgb green = bands.colour(std::array{0.1, 0.5, 0.1});  // linear Rec. 709 under D65
/// ```
class channels {
 public:
  /// Red, green and blue, linear Rec. 709.
  channels() = default;

  /// Takes wavelengths in nanometres, and the light under which they are seen. Throws gonio::error unless they are
  /// positive, finite and ascending.
  explicit channels(std::vector<double> wavelengths, illuminant light = illuminant::d65);

  /// Returns the channel of a value without a stated wavelength, as read by a photometer.
  [[nodiscard]] static channels one_value();

  /// Returns the number of channels.
  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  /// Returns true for red, green and blue.
  [[nodiscard]] bool are_colours() const noexcept { return size_ == 3 && wavelengths_.empty(); }
  /// Returns true for several wavelengths.
  [[nodiscard]] bool are_wavelengths() const noexcept { return wavelengths_.size() > 1; }
  /// Returns the wavelengths in nanometres, ascending; none for colours, and for a value without a stated wavelength.
  [[nodiscard]] const std::vector<double>& wavelengths() const noexcept { return wavelengths_; }
  /// Returns the light under which wavelengths are seen.
  [[nodiscard]] illuminant light() const noexcept { return light_; }
  /// Returns "red", "550 nm", or "value", for example.
  [[nodiscard]] std::string name(Eigen::Index channel) const;

  /// Returns true if the channels make a colour. Several wavelengths do if one of them is visible; one channel is grey.
  [[nodiscard]] bool have_colour() const noexcept { return !are_wavelengths() || colour_.has_value(); }
  /// Returns the linear Rec. 709 colour of `values`, one for each channel; black if no wavelength is visible.
  [[nodiscard]] rgb colour(std::span<const double> values) const;
  /// Returns three numbers for computing, not for display: the colour or, if no wavelength is visible, the means of the
  /// lower, the middle and the upper third of the wavelengths.
  [[nodiscard]] rgb three(std::span<const double> values) const;
  /// Returns the names of these three numbers: colours, or "900 to 1200 nm" and so on.
  [[nodiscard]] std::array<std::string, 3> names_of_three() const;
  /// Returns the same channels under another light.
  [[nodiscard]] channels under(illuminant light) const;

  [[nodiscard]] friend bool operator==(const channels& a, const channels& b) {
    return a.size_ == b.size_ && a.wavelengths_ == b.wavelengths_;
  }

 private:
  Eigen::Index size_ = 3;
  std::vector<double> wavelengths_;
  illuminant light_ = illuminant::d65;
  std::optional<spectral_colour> colour_;  ///< converts several wavelengths, if one of them is visible
};

/// Throws gonio::error, saying that `name` has no colour, if no wavelength is visible.
void require_colour(const channels& all, const std::string& name);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/channels.ipp>
#endif
