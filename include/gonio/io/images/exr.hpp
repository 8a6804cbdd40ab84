#pragma once
/// OpenEXR images of linear light: channels R, G and B, or Y alone, of 16 or 32 bits. Unlike HDR files they hold
/// negative and infinite values, and all digits of a float. Needs OpenEXR 3 (gonio::exr); its headers are not included.
/// Format: openexr.com/en/latest/OpenEXRFileLayout.html.

#include <gonio/core/parallel.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace gonio::io {

/// The image in the bytes of an OpenEXR file of scan lines or tiles; its data window is the image. Other channels are
/// ignored. Throws gonio::error starting with `name` if the bytes are no such file or are truncated, if the image has
/// more than 16384 pixels one way or more pixels than is believable of the bytes, if there is neither R, G and B nor Y,
/// and if a value is a NaN.
[[nodiscard]] image read_exr(std::span<const std::byte> bytes, const std::string& name);

/// Reads an OpenEXR file.
[[nodiscard]] image read_exr(const std::filesystem::path& path);

namespace detail {
class exr_decoder;
}

/// An open OpenEXR file that is read some rows at a time. In memory is a block of its lines, 1 to 256 as it was
/// compressed, or a row of its tiles.
class exr_rows {
 public:
  /// Looks at the header and where each block of lines or tile is. Throws gonio::error as `read_exr` does, if a block
  /// is missing or ends behind the file, and if tiles have more than 512 rows.
  explicit exr_rows(const std::filesystem::path& path);
  exr_rows(exr_rows&&) noexcept;
  exr_rows& operator=(exr_rows&&) noexcept;
  ~exr_rows();

  [[nodiscard]] Eigen::Index rows() const noexcept;
  [[nodiscard]] Eigen::Index columns() const noexcept;

  /// Red, green and blue of the pixels of some rows, one row after the other, NaN included. `out` has 3 x columns x
  /// rows numbers. One thread at a time. Throws gonio::error if a block of lines cannot be decoded.
  void read(block rows, std::span<float> out) const;

 private:
  std::unique_ptr<detail::exr_decoder> decoder_;
};

/// Writes an OpenEXR file of 32-bit channels, deflated (ZIP). NaN is refused.
void write_exr(const std::filesystem::path& path, const image& picture);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/images/impl/exr.ipp>
#endif
