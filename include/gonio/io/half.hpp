#pragma once
/// Half floats, as arrays of numpy ('<f2') hold them: IEEE 754 binary16, 11 bits of precision, up to 65504, in steps of
/// 2^-24 below 2^-14.

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace gonio::io {

inline constexpr float largest_half = 65504.0f;

/// The number that 16 bits stand for.
[[nodiscard]] inline float from_half(std::uint16_t bits) noexcept {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const float magnitude = exponent == 0   ? std::ldexp(static_cast<float>(fraction), -24)
                          : exponent < 31 ? std::ldexp(static_cast<float>(1024 + fraction), exponent - 25)
                          : fraction == 0 ? std::numeric_limits<float>::infinity()
                                          : std::numeric_limits<float>::quiet_NaN();
  return (bits & 0x8000) != 0 ? -magnitude : magnitude;
}

/// The bits of the nearest half, of the even one if two are as near; infinity from 65520 on.
[[nodiscard]] inline std::uint16_t to_half(float value) noexcept {
  const auto sign = static_cast<std::uint16_t>(std::signbit(value) ? 0x8000 : 0);
  const float magnitude = std::abs(value);
  if (std::isnan(value)) return static_cast<std::uint16_t>(sign | 0x7E00);
  if (magnitude >= 65520.0f) return static_cast<std::uint16_t>(sign | 0x7C00);
  // In units of the last bit, which rounding takes to even; a carry goes on into the exponent, as it should.
  int exponent = 0;
  static_cast<void>(std::frexp(magnitude, &exponent));
  const int above_subnormal = magnitude < 0x1p-14f ? 0 : exponent + 14;
  const float units = std::ldexp(magnitude, above_subnormal == 0 ? 24 : 25 - above_subnormal);
  const int whole = static_cast<int>(std::nearbyint(units));
  return static_cast<std::uint16_t>(sign | (above_subnormal == 0 ? whole : (above_subnormal << 10) + whole - 1024));
}

}  // namespace gonio::io
