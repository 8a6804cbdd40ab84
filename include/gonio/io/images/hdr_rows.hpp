#pragma once
/// Radiance HDR images (RGBE), read some rows at a time. Only the position of each row is kept in memory. Format: G.
/// Ward, Real Pixels, Graphics Gems II (1991); radsite.lbl.gov/radiance/refer/filefmts.pdf.

#include <gonio/core/parallel.hpp>
#include <gonio/io/bytes/file.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

/// An open HDR file. Any number of threads may read from it.
class hdr_rows {
 public:
  /// Reads through the file once. Throws gonio::error naming the file if it is not an HDR image, is truncated or
  /// damaged, has bytes after its last row, has more than 16384 rows or columns, or axes other than -Y or +Y and +X.
  explicit hdr_rows(const std::filesystem::path& path);

  [[nodiscard]] Eigen::Index rows() const noexcept { return std::ssize(begins_) - 1; }
  [[nodiscard]] Eigen::Index columns() const noexcept { return columns_; }

  /// Reads the RGB pixels of some rows, from the top, in linear Rec. 709: the stored numbers, divided by EXPOSURE and
  /// COLORCORR, and converted from PRIMARIES or XYZ if the header names them. Colours outside the gamut are negative.
  /// `out` has 3 x columns x rows numbers. Throws gonio::error if the file was changed meanwhile.
  void read(block rows, std::span<float> out) const;

 private:
  class row_reader;

  std::string name_;
  descriptor file_;
  Eigen::Index columns_ = 0;
  bool has_runs_ = false;  ///< rows are run-length encoded
  bool from_bottom_ = false, has_colours_ = false;
  Eigen::Matrix3f colours_;            ///< converts stored numbers to Rec. 709
  std::vector<std::uint64_t> begins_;  ///< position of each row in the file, and the end of the last row
};

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/images/impl/hdr_rows.ipp>
#endif
