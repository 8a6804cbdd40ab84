#pragma once
/// Half floats (IEEE 754 binary16) as files and textures hold them: 11 bits of precision, up to 65504, in steps of
/// 2^-24 below 2^-14.

#include <Eigen/Core>

#include <cstdint>

namespace gonio {

/// The number that the bits stand for.
[[nodiscard]] inline float from_half(std::uint16_t bits) noexcept {
  return static_cast<float>(Eigen::half(Eigen::half_impl::raw_uint16_to_half(bits)));
}

/// The bits of the nearest half float; infinity beyond their range.
[[nodiscard]] inline std::uint16_t to_half(float value) noexcept { return static_cast<Eigen::half>(value).x; }

}  // namespace gonio
