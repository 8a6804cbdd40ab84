#pragma once
/// Images: PNG (8 bits, sRGB) and Radiance HDR (RGBE), converted to and from linear light. Needs zlib and stb.
///
/// Only stb's declarations are included. Debian's libstb, which gonio::image links, has the code. Elsewhere, one source
/// file of the program must define STB_IMAGE_IMPLEMENTATION and STB_IMAGE_WRITE_IMPLEMENTATION before it includes
/// <stb/stb_image.h> and <stb/stb_image_write.h>.

#include <gonio/core/rgb.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/bytes/gzip.hpp>
#include <gonio/io/images/hdr_rows.hpp>
#include <gonio/render/image.hpp>
#include <gonio/table/stored_codes.hpp>

#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

namespace detail {

struct stb_deleter {
  void operator()(void* pixels) const noexcept { stbi_image_free(pixels); }
};
template <class T>
using stb_pixels = std::unique_ptr<T[], stb_deleter>;

/// Returns the number of bytes as an int, which stb needs.
[[nodiscard]] int stb_size(std::span<const std::byte> bytes, const std::string& name);

[[nodiscard]] inline const stbi_uc* stb_bytes(std::span<const std::byte> bytes) noexcept {
  return reinterpret_cast<const stbi_uc*>(bytes.data());
}

[[noreturn]] void refuse_by_stb(const std::string& name);

/// Returns the linear light of a display value in [0, 1]; the inverse of `encode_srgb`.
[[nodiscard]] inline double srgb_to_linear(double encoded) noexcept {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// ---- PNG: stb decodes, but checks neither checksums nor that the file ends where it should ----

/// The fields of a PNG's header chunk that determine how many bytes its pixels take.
struct png_header {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::size_t depth = 0;
  std::size_t channels = 0;
  bool interlaced = false;

  /// Returns the number of bytes of the filtered rows before compression.
  [[nodiscard]] std::size_t raw_size() const noexcept;
};

[[nodiscard]] std::uint32_t big_endian(std::span<const std::byte> bytes) noexcept;

[[nodiscard]] png_header read_png_header(std::span<const std::byte> data, const std::string& name);

/// Walks a PNG's chunks. Throws gonio::error unless all are complete with correct checksums, the last is IEND with
/// nothing after it, and the pixels expand to exactly the size that the header gives.
void check_png(std::span<const std::byte> bytes, const std::string& name);

// ---- Radiance HDR is read by io/images/hdr_rows.hpp ----------------------------------------------

/// Rounds a colour to 8-bit mantissas with a common exponent, as RGBE stores it; stb would truncate.
[[nodiscard]] std::array<float, 3> round_to_rgbe(const float* pixel) noexcept;

// ---- writing --------------------------------------------------------------------------------

/// Collects stb's output; an exception must not pass through its C code.
struct byte_sink {
  std::vector<std::byte> bytes;
  bool failed = false;

  static void write(void* user, void* data, int size) noexcept;
};

struct stb_extents {
  int columns = 0;
  int rows = 0;
};

/// Checks an image before it is written and returns its size; the format can hold values up to `brightest`.
[[nodiscard]] stb_extents check_pixels(const image& picture, float brightest, const std::string& name);

}  // namespace detail

/// Reads a PNG of any kind: palettes are resolved, grey becomes RGB, 16 bits become 8, alpha is dropped.
[[nodiscard]] image read_png(const std::filesystem::path& path);

/// Reads the stored codes of a PNG of 8 or 16 bits: grey becomes three equal channels, alpha is dropped.
[[nodiscard]] stored_codes read_png_codes(const std::filesystem::path& path);

/// Returns the bytes of a PNG file as `write_png` writes it. Errors call the file `name`.
[[nodiscard]] std::vector<std::byte> write_png(const image& picture, const std::string& name);

/// Writes a PNG: values are clipped to [0, 1], sRGB-encoded and rounded to 8 bits. Refuses NaN.
void write_png(const std::filesystem::path& path, const image& picture);

/// Reads a Radiance HDR image as linear Rec. 709; see `hdr_rows::read`.
[[nodiscard]] image read_hdr(const std::filesystem::path& path);

/// Writes a Radiance HDR image. Negative values become 0. Refuses NaN, and values from 1.7e38 on, too large for RGBE.
void write_hdr(const std::filesystem::path& path, const image& picture);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/images/impl/image.ipp>
#endif
