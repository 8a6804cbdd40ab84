#pragma once
/// Colours, linear in Rec. 709 primaries, and quantities derived from them: luminance, CIE XYZ, CIELAB 1976, and the
/// sRGB transfer curve (IEC 61966-2-1). White is D65.

#include <gonio/core/compiled_alignment.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace gonio {

/// A linear colour, or any quantity with one value per colour channel.
using rgb = Eigen::Array3d;

/// Returns the luminance Y of a linear Rec. 709 colour (white has luminance 1).
[[nodiscard]] inline double luminance(const rgb& colour) noexcept {
  return 0.2126 * colour.x() + 0.7152 * colour.y() + 0.0722 * colour.z();
}

/// Returns the CIE XYZ of a linear Rec. 709 colour, with Y = 1 for white.
[[nodiscard]] inline rgb to_xyz(const rgb& colour) noexcept {
  return {0.4124564 * colour.x() + 0.3575761 * colour.y() + 0.1804375 * colour.z(),
          0.2126729 * colour.x() + 0.7151522 * colour.y() + 0.0721750 * colour.z(),
          0.0193339 * colour.x() + 0.1191920 * colour.y() + 0.9503041 * colour.z()};
}

/// Returns the linear Rec. 709 colour of CIE XYZ: the inverse of `to_xyz`. Components are negative outside of the
/// gamut.
[[nodiscard]] inline rgb from_xyz(const rgb& xyz) noexcept {
  return {3.2404542 * xyz.x() - 1.5371385 * xyz.y() - 0.4985314 * xyz.z(),
          -0.9692660 * xyz.x() + 1.8760108 * xyz.y() + 0.0415560 * xyz.z(),
          0.0556434 * xyz.x() - 0.2040259 * xyz.y() + 1.0572252 * xyz.z()};
}

namespace detail {

/// Returns CIELAB's function of the ratio of an XYZ channel to that of white: the cube root, but linear near black.
[[nodiscard]] inline double lab_curve(double relative) noexcept {
  constexpr double knee = 6.0 / 29.0;
  return relative > knee * knee * knee ? std::cbrt(relative) : relative / (3.0 * knee * knee) + 4.0 / 29.0;
}

}  // namespace detail

/// Returns the CIELAB 1976 (L*, a*, b*) of a linear Rec. 709 colour under D65. A highlight has L* above 100.
[[nodiscard]] inline rgb to_unclipped_lab(const rgb& colour) noexcept {
  const rgb xyz = to_xyz(colour);
  const double x = detail::lab_curve(xyz.x() / 0.95047), y = detail::lab_curve(xyz.y()),
               z = detail::lab_curve(xyz.z() / 1.08883);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

/// Returns the CIELAB of the colour clipped to [0, 1], as on a display.
[[nodiscard]] inline rgb to_lab(const rgb& colour) noexcept {
  // NaN stays NaN.
  const auto clipped = [](double channel) { return channel < 0.0 ? 0.0 : channel > 1.0 ? 1.0 : channel; };
  return to_unclipped_lab({clipped(colour.x()), clipped(colour.y()), clipped(colour.z())});
}

/// Returns the CIE 1976 colour difference Delta E*ab of two linear colours, clipped as in `to_lab`.
[[nodiscard]] inline double delta_e(const rgb& a, const rgb& b) noexcept {
  const rgb p = to_lab(a), q = to_lab(b);
  const double l = p.x() - q.x(), green_red = p.y() - q.y(), blue_yellow = p.z() - q.z();
  return std::sqrt(l * l + (green_red * green_red + blue_yellow * blue_yellow));
}

/// Applies the sRGB transfer curve: linear light in [0, 1] (clipped) to a display value in [0, 1].
[[nodiscard]] inline double encode_srgb(double linear) noexcept {
  const double clipped = std::clamp(linear, 0.0, 1.0);
  return clipped <= 0.0031308 ? 12.92 * clipped : 1.055 * std::pow(clipped, 1.0 / 2.4) - 0.055;
}

}  // namespace gonio
