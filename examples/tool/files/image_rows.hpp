#pragma once
/// Images of linear radiance, read some rows at a time; only these rows are in memory.

#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <filesystem>
#include <memory>
#include <span>

namespace cli {

/// An open image.
class image_rows {
 public:
  image_rows() = default;
  image_rows(const image_rows&) = delete;
  image_rows& operator=(const image_rows&) = delete;
  virtual ~image_rows() = default;

  [[nodiscard]] virtual Eigen::Index rows() const = 0;
  [[nodiscard]] virtual Eigen::Index columns() const = 0;

  /// Announces the rows to be read next. The system reads them ahead if their position in the file is known.
  virtual void will_read(gonio::block rows) const noexcept { static_cast<void>(rows); }
  /// Reads red, green and blue of each pixel of a range of rows; `out` has 3 x columns x rows numbers. Not thread-safe.
  /// Throws gonio::error naming the image.
  virtual void read(gonio::block rows, std::span<float> out) const = 0;
};

/// Adapts a reader with `rows()`, `columns()` and `read(rows, out)`.
template <class Reader>
class image_rows_of : public image_rows {
 public:
  explicit image_rows_of(const std::filesystem::path& path) : reader_(path) {}

  [[nodiscard]] Eigen::Index rows() const override { return reader_.rows(); }
  [[nodiscard]] Eigen::Index columns() const override { return reader_.columns(); }
  void read(gonio::block rows, std::span<float> out) const override { reader_.read(rows, out); }

 private:
  Reader reader_;
};

/// Opens .npy (rows x columns x 3), .exr or .hdr. Throws gonio::error naming the image that cannot be read.
[[nodiscard]] std::unique_ptr<image_rows> open_image(const std::filesystem::path& path);

}  // namespace cli
