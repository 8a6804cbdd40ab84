#pragma once
/// OpenEXR images of linear light: channels R, G and B, or only Y, of 16 or 32 bits. Unlike HDR files they can hold
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

/// Reads the image in the data window of an OpenEXR file of scan lines or tiles; ignores other channels. Throws
/// gonio::error starting with `name` if the bytes are of any other kind of file or are truncated, if the image has more
/// than 16384 rows or columns or more pixels than the file's size allows, if it has neither R, G and B nor Y, or if a
/// value is NaN.
[[nodiscard]] image read_exr(std::span<const std::byte> bytes, const std::string& name);

/// Reads an OpenEXR file.
[[nodiscard]] image read_exr(const std::filesystem::path& path);

namespace detail {
class exr_decoder;
}

/// An open OpenEXR file, read some rows at a time. Keeps in memory one row of tiles or one block of lines: 1 to 256
/// lines, depending on the compression.
class exr_rows {
 public:
  /// Reads the header and the position of each tile or block of lines. Throws gonio::error if `read_exr` would refuse
  /// the header, if a block is missing or reaches past the file's end, or if tiles have more than 512 rows.
  explicit exr_rows(const std::filesystem::path& path);
  exr_rows(exr_rows&&) noexcept;
  exr_rows& operator=(exr_rows&&) noexcept;
  ~exr_rows();

  [[nodiscard]] Eigen::Index rows() const noexcept;
  [[nodiscard]] Eigen::Index columns() const noexcept;

  /// Reads the RGB pixels of some rows, row by row; NaN is kept. `out` has 3 x columns x rows numbers. Not thread-safe.
  /// Throws gonio::error if a block of lines cannot be decoded.
  void read(block rows, std::span<float> out) const;

 private:
  std::unique_ptr<detail::exr_decoder> decoder_;
};

/// Writes an OpenEXR file of 32-bit channels, deflated (ZIP). Refuses NaN.
void write_exr(const std::filesystem::path& path, const image& picture);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/images/impl/exr.ipp>
#endif
