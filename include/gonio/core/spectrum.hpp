#pragma once
/// Colours of spectral reflectance: CIE 1931 2-degree observer, by the fits of Wyman, Sloan and Shirley, "Simple
/// Analytic Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013 (section 2.2), under the CIE
/// standard illuminants D65 and A (ISO 11664-2).

#include <gonio/core/assertion.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/rgb.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace gonio {

/// Returns the observer's three responses at a wavelength in nanometres. The error is about 1 % of the peak.
[[nodiscard]] inline rgb colour_matching(double wavelength) noexcept {
  const auto lobe = [wavelength](double height, double centre, double below, double above) {
    const double z = (wavelength - centre) / (wavelength < centre ? below : above);
    return height * std::exp(-0.5 * z * z);
  };
  return {lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) - lobe(0.065, 501.1, 20.4, 26.2),
          lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
          lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8)};
}

/// Returns true for wavelengths from 360 to 830 nanometres, the range of the standard's responses. Outside, the fits
/// are small but not zero.
[[nodiscard]] inline bool is_visible(double wavelength) noexcept { return wavelength >= 360.0 && wavelength <= 830.0; }

/// Returns the relative power of daylight D65 at a wavelength in nanometres, 100 at 560. Linear between the standard's
/// values every 10 nanometres from 380 to 780, constant outside.
[[nodiscard]] inline double daylight(double wavelength) noexcept {
  constexpr std::array power{49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812,
                             114.861, 115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046,
                             100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992,
                             80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.3490, 61.6040, 69.8856,
                             75.0870, 63.5927, 46.4182, 66.8054, 63.3828};
  const double position = std::clamp((wavelength - 380.0) / 10.0, 0.0, static_cast<double>(power.size() - 1));
  const auto below = std::min(static_cast<Eigen::Index>(position), std::ssize(power) - 2);
  return std::lerp(power[below], power[below + 1], position - static_cast<double>(below));
}

/// Returns the relative power of incandescent light A at a wavelength in nanometres, 100 at 560: Planck's law at 2848 K
/// with the second radiation constant 1.435e-2 m K, as the standard defines it.
[[nodiscard]] inline double incandescent(double wavelength) noexcept {
  constexpr double exponent = 1.435e7 / 2848.0, reference = 560.0;  // nanometres
  return 100.0 * std::pow(reference / wavelength, 5) * std::expm1(exponent / reference) /
         std::expm1(exponent / wavelength);
}

/// The light under which a reflectance is observed.
enum class illuminant { d65, a };

/// Returns the relative power of an illuminant at a wavelength in nanometres, 100 at 560.
[[nodiscard]] inline double relative_power(illuminant light, double wavelength) noexcept {
  return light == illuminant::a ? incandescent(wavelength) : daylight(wavelength);
}

/// Converts reflectance at given wavelengths to linear Rec. 709, by the trapezoidal rule. XYZ is relative to the
/// illuminant's white, as in CIELAB, and that white becomes (1, 1, 1). A constant reflectance therefore becomes a grey
/// of that value, and `unclipped_lab` is CIELAB under that illuminant.
class spectral_colour {
 public:
  /// Takes wavelengths in nanometres. Throws gonio::error unless there are at least two, finite and ascending, and at
  /// least one is visible (`is_visible`).
  explicit spectral_colour(std::span<const double> wavelengths, illuminant light = illuminant::d65)
      : weights_(std::ssize(wavelengths), 3) {
    if (wavelengths.size() < 2) refuse("a spectrum needs at least two wavelengths");
    for (Eigen::Index i = 0; i < std::ssize(wavelengths); ++i) {
      if (!std::isfinite(wavelengths[i]) || (i > 0 && !(wavelengths[i] > wavelengths[i - 1])))
        refuse({"wavelength ", i + 1, " of a spectrum is not above the one before"});
      const double from = wavelengths[i == 0 ? 0 : i - 1],
                   to = wavelengths[std::min(i + 1, std::ssize(wavelengths) - 1)];
      const double power = is_visible(wavelengths[i]) ? 0.5 * (to - from) * relative_power(light, wavelengths[i]) : 0.0;
      const rgb matching = colour_matching(wavelengths[i]);
      for (Eigen::Index c = 0; c < 3; ++c) weights_(i, c) = power * matching[c];
    }
    const rgb wanted = to_xyz(rgb::Ones());
    for (Eigen::Index c = 0; c < 3; ++c) {
      double white = 0.0;
      for (Eigen::Index i = 0; i < size(); ++i) white += weights_(i, c);
      if (!(white > 0.0))
        refuse({"none of ", wavelengths.size(), " wavelengths, ", std::lround(wavelengths.front()), " to ",
                std::lround(wavelengths.back()), " nm, is visible: they have no colour"});
      for (Eigen::Index i = 0; i < size(); ++i) weights_(i, c) *= wanted[c] / white;
    }
  }

  /// Returns the number of wavelengths.
  [[nodiscard]] Eigen::Index size() const noexcept { return weights_.rows(); }

  /// Returns the colour of a reflectance that has one value for each wavelength. Components of saturated colours may be
  /// negative.
  [[nodiscard]] rgb operator()(std::span<const double> reflectance) const { return colour_of(reflectance); }
  /// Returns the colour of a reflectance in single precision.
  [[nodiscard]] rgb operator()(std::span<const float> reflectance) const { return colour_of(reflectance); }

 private:
  template <class Number>
  [[nodiscard]] rgb colour_of(std::span<const Number> reflectance) const {
    GONIO_ASSERT(std::ssize(reflectance) == size());
    rgb xyz(0.0, 0.0, 0.0);
    for (Eigen::Index band = 0; band < size(); ++band)
      for (Eigen::Index c = 0; c < 3; ++c) xyz[c] += weights_(band, c) * double{reflectance[band]};
    return from_xyz(xyz);
  }

  Eigen::ArrayX3d weights_;
};

/// Returns the CIELAB 1976 (L*, a*, b*) of a `spectral_colour` under its illuminant, inside and outside of the gamut of
/// Rec. 709. `to_lab` clips instead, as a display does.
[[nodiscard]] inline rgb unclipped_lab(const rgb& colour) noexcept {
  const rgb relative = to_xyz(colour) / to_xyz(rgb::Ones());
  const double x = detail::lab_curve(relative.x()), y = detail::lab_curve(relative.y()),
               z = detail::lab_curve(relative.z());
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

}  // namespace gonio
