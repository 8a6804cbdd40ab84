#pragma once
/// Half floats (IEEE 754 binary16), as used in files and textures: 11 bits of precision, up to 65504, in steps of 2^-24
/// below 2^-14.

#include <Eigen/Core>

#include <cstdint>

namespace gonio {

/// Returns the number that the bits represent.
[[nodiscard]] inline float from_half(std::uint16_t bits) noexcept {
  return static_cast<float>(Eigen::half(Eigen::half_impl::raw_uint16_to_half(bits)));
}

/// Returns the bits of the nearest half float; infinity for a value outside of the range of half floats.
[[nodiscard]] inline std::uint16_t to_half(float value) noexcept { return static_cast<Eigen::half>(value).x; }

}  // namespace gonio
