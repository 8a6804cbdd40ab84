#pragma once
/// Colours, linear in Rec. 709 primaries, and what is derived from them: luminance, CIE XYZ, CIELAB 1976,
/// and the sRGB transfer curve (IEC 61966-2-1). White is D65.

#include <gonio/core/compiled_alignment.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace gonio {

/// A linear colour, or any quantity with one value per colour channel.
using rgb = Eigen::Array3d;

/// Luminance Y of a linear Rec. 709 colour (white has luminance 1).
[[nodiscard]] inline double luminance(const rgb& colour) noexcept {
  return 0.2126 * colour.x() + 0.7152 * colour.y() + 0.0722 * colour.z();
}

/// CIE XYZ of a linear Rec. 709 colour, Y of white being 1.
[[nodiscard]] inline rgb to_xyz(const rgb& colour) noexcept {
  return {0.4124564 * colour.x() + 0.3575761 * colour.y() + 0.1804375 * colour.z(),
          0.2126729 * colour.x() + 0.7151522 * colour.y() + 0.0721750 * colour.z(),
          0.0193339 * colour.x() + 0.1191920 * colour.y() + 0.9503041 * colour.z()};
}

/// The linear Rec. 709 colour of CIE XYZ: the inverse of `to_xyz`. Negative where the colour is outside of the gamut.
[[nodiscard]] inline rgb from_xyz(const rgb& xyz) noexcept {
  return {3.2404542 * xyz.x() - 1.5371385 * xyz.y() - 0.4985314 * xyz.z(),
          -0.9692660 * xyz.x() + 1.8760108 * xyz.y() + 0.0415560 * xyz.z(),
          0.0556434 * xyz.x() - 0.2040259 * xyz.y() + 1.0572252 * xyz.z()};
}

/// CIELAB 1976 (L*, a*, b*) of a linear Rec. 709 colour under D65. The colour is clipped to [0, 1]
/// first, as a display would.
[[nodiscard]] inline rgb to_lab(const rgb& colour) noexcept {
  constexpr double knee = 6.0 / 29.0;
  const rgb white(0.95047, 1.0, 1.08883);
  const rgb relative = to_xyz(colour.max(0.0).min(1.0)) / white;
  const rgb f = relative.unaryExpr(
      [](double t) { return t > knee * knee * knee ? std::cbrt(t) : t / (3.0 * knee * knee) + 4.0 / 29.0; });
  return {116.0 * f.y() - 16.0, 500.0 * (f.x() - f.y()), 200.0 * (f.y() - f.z())};
}

/// CIE 1976 colour difference Delta E*ab of two linear colours.
[[nodiscard]] inline double delta_e(const rgb& a, const rgb& b) noexcept {
  return (to_lab(a) - to_lab(b)).matrix().norm();
}

/// The sRGB transfer curve: linear light in [0, 1] (clipped) to a display value in [0, 1].
[[nodiscard]] inline double encode_srgb(double linear) noexcept {
  const double clipped = std::clamp(linear, 0.0, 1.0);
  return clipped <= 0.0031308 ? 12.92 * clipped : 1.055 * std::pow(clipped, 1.0 / 2.4) - 0.055;
}

}  // namespace gonio
