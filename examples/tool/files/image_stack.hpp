#pragma once
/// Registered images of a flat sample, one for each pair of directions, read in bands of rows; only one band of all
/// images is in memory.

#include "image_list.hpp"
#include "image_rows.hpp"
#include <gonio/core/parallel.hpp>
#include <gonio/io/bytes/file.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cli {

/// Reflectance in sr^-1 of a range of texels: a column per image, with red, green and blue texel by texel.
struct texel_values {
  Eigen::MatrixXf reflectance;
  std::vector<Eigen::Index> outside;  ///< the texels outside the sample, whose values are zeros
};

class image_stack {
 public:
  /// Opens all images (`open_image`), and decodes a mask into an unnamed file in `folder`, a byte for each texel.
  /// Throws gonio::error naming the image that cannot be read or whose size differs from the first.
  image_stack(const image_list& list, const std::filesystem::path& folder);

  [[nodiscard]] Eigen::Index rows() const noexcept { return rows_; }
  [[nodiscard]] Eigen::Index columns() const noexcept { return columns_; }

  /// Announces the rows to be read next, as `image_rows::will_read`.
  void will_read(gonio::block rows) const noexcept;
  /// Returns the texels of a range of rows. A texel with a value that is not finite counts as outside the sample if
  /// such texels are skipped; otherwise throws gonio::error naming the image and the texel.
  [[nodiscard]] texel_values read(gonio::block rows, gonio::thread_count threads) const;

 private:
  struct source {
    std::string name;
    std::unique_ptr<image_rows> image;
    float factor = 1.0f;  ///< converts the image's numbers to sr^-1
  };
  struct decoded_mask {
    std::string name;
    gonio::io::descriptor file;
  };

  [[nodiscard]] decoded_mask read_mask(const std::filesystem::path& path, const std::filesystem::path& folder) const;
  /// Returns a byte for each texel, zero inside the sample according to the mask.
  [[nodiscard]] std::vector<std::uint8_t> masked(gonio::block rows) const;
  /// Marks the texels of an image whose values are not finite as outside; without `skips_invalid`, refuses the first.
  void mark_invalid(const source& image, const Eigen::Ref<const Eigen::VectorXf>& values, Eigen::Index first_row,
                    std::vector<std::uint8_t>& outside) const;
  void require_size(const std::string& name, Eigen::Index rows, Eigen::Index columns) const;

  Eigen::Index rows_ = 0, columns_ = 0;
  std::vector<source> sources_;
  std::optional<decoded_mask> mask_;
  bool skips_invalid_;
};

}  // namespace cli
