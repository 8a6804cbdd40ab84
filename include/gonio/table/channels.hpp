#pragma once
/// The channels of measurements and of what is fitted to them: colours, wavelengths, or one value.

#include <gonio/core/rgb.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/core/wavelengths.hpp>

#include <Eigen/Core>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gonio {

/// What each of c numbers is that belong to a pair of directions.
///
/// ```cpp
/// const gonio::channels bands({450.0, 550.0, 650.0});
/// const gonio::rgb green = bands.colour(std::array{0.1, 0.5, 0.1});  // linear Rec. 709 under D65
/// ```
class channels {
 public:
  /// Red, green and blue, linear Rec. 709.
  channels() = default;

  /// Wavelengths in nanometres, and the light under which they are seen. Throws gonio::error unless they are positive,
  /// finite and ascending.
  explicit channels(std::vector<double> wavelengths, illuminant light = illuminant::d65);

  /// One value of no stated wavelength, as a photometer reads it.
  [[nodiscard]] static channels one_value();

  /// The number of channels.
  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  /// Red, green and blue?
  [[nodiscard]] bool are_colours() const noexcept { return size_ == 3 && wavelengths_.empty(); }
  /// Several wavelengths?
  [[nodiscard]] bool are_wavelengths() const noexcept { return wavelengths_.size() > 1; }
  /// Nanometres, ascending; none for colours, and for a value of no stated wavelength.
  [[nodiscard]] const std::vector<double>& wavelengths() const noexcept { return wavelengths_; }
  /// Under which wavelengths are seen.
  [[nodiscard]] illuminant light() const noexcept { return light_; }
  /// "red", "550 nm", "value".
  [[nodiscard]] std::string name(Eigen::Index channel) const;

  /// Do they make a colour? Wavelengths do if one of them is visible; one channel, whatever it is, makes a grey.
  [[nodiscard]] bool have_colour() const noexcept { return !are_wavelengths() || colour_.has_value(); }
  /// The linear Rec. 709 colour of as many values; black where no wavelength is visible.
  [[nodiscard]] rgb colour(std::span<const double> values) const;
  /// Three numbers for whoever looks at three and shows none: the colour or, where no wavelength is visible, the means
  /// of the lower, the middle and the upper third of the wavelengths.
  [[nodiscard]] rgb three(std::span<const double> values) const;
  /// The same channels under another light.
  [[nodiscard]] channels under(illuminant light) const;

  [[nodiscard]] friend bool operator==(const channels& a, const channels& b) {
    return a.size_ == b.size_ && a.wavelengths_ == b.wavelengths_;
  }

 private:
  Eigen::Index size_ = 3;
  std::vector<double> wavelengths_;
  illuminant light_ = illuminant::d65;
  std::optional<spectral_colour> colour_;  ///< of several wavelengths, if one is visible
};

/// Refuses invisible wavelengths: throws gonio::error saying that `name` has no colour.
void require_colour(const channels& all, const std::string& name);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/channels.ipp>
#endif
