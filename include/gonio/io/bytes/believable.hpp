#pragma once
/// Limits on the expanded size that a file claims, checked before memory is allocated: a short deflated file can claim
/// gigabytes. Files of instruments and of this library shrink far less. docs/reference/formats.md, "Limits".

#include <gonio/core/error.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace gonio::io::detail {

/// Bytes that a table may claim however small its file is. A MERL table has 35 MB; one with equal values shrinks
/// 1000-fold.
inline constexpr std::uint64_t freely_claimed_table = std::uint64_t{36} << 20;

/// Bytes that a payload may claim however small its file is. A prior of one component over MERL's grid has 5.5 MB.
inline constexpr std::uint64_t freely_claimed_payload = std::uint64_t{8} << 20;

/// Bytes that a file may claim for each deflated byte, in addition to `freely_claimed_table` or
/// `freely_claimed_payload`. The shipped prior has 33; deflate's maximum is 1032.
inline constexpr std::uint64_t believable_expansion = 64;

[[nodiscard]] constexpr bool is_believable(std::uint64_t claimed, std::uint64_t freely,
                                           std::size_t compressed) noexcept {
  return claimed <= freely || (claimed - freely) / believable_expansion <= compressed;
}

/// Limits for an image format: `freely` pixels for a file of any size, and `per_byte` more pixels for each byte of the
/// file.
struct pixel_claims {
  std::size_t freely, per_byte;

  [[nodiscard]] constexpr bool are_believable(std::size_t pixels, std::size_t bytes) const noexcept {
    return pixels <= freely || (pixels - freely) / per_byte <= bytes;
  }
};

/// The decoder takes at most 16 bytes of memory per pixel. The file of a photograph has at least one byte per pixel.
inline constexpr pixel_claims png_claims{4'000'000, 16};

/// The decoder takes 24 bytes of memory per pixel.
inline constexpr pixel_claims hdr_claims{2'700'000, 4};

/// The largest number of rows or columns of an image.
inline constexpr std::size_t image_limit = 16384;

inline void check_image_size(std::size_t rows, std::size_t columns, const std::string& name) {
  if (rows < 1 || columns < 1 || rows > image_limit || columns > image_limit)
    gonio::refuse(
        {name, ": an image of ", columns, " x ", rows, " pixels, expected from 1 to ", image_limit, " each way"});
}

/// Refuses an image with more pixels than a file of `bytes` bytes plausibly holds: decoding it could take gigabytes.
inline void check_believable_pixels(const pixel_claims& claims, std::size_t rows, std::size_t columns,
                                    std::size_t bytes, const std::string& name) {
  if (!claims.are_believable(rows * columns, bytes))
    gonio::refuse({name, ": an image of ", columns, " x ", rows, " pixels cannot fit in ", bytes, " bytes"});
}

}  // namespace gonio::io::detail
