#pragma once
/// Registered images of a flat sample, one for each pair of directions, read in bands of rows: no more than a band of
/// all of them is in memory.

#include <gonio/core/direction.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/io/file.hpp>
#include <gonio/io/sample_quantity.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace cli {

struct listed_image {
  std::filesystem::path file;
  gonio::direction_pair at;
};

/// What a list of images says (JSON; docs/reference/formats.md).
struct image_list {
  gonio::io::sample_quantity quantity = gonio::io::sample_quantity::brdf;
  std::vector<listed_image> images;
};

/// Throws gonio::error naming the list and the image of it that is not what it should be.
[[nodiscard]] image_list read_image_list(const std::filesystem::path& path);

class image_stack {
 public:
  /// Opens all images: .npy is read from its place; .exr and .hdr, of which no part can be read alone, are decoded one
  /// after the other into a file without a name in `folder`. Throws gonio::error naming the image that cannot be read,
  /// or has another size than the first.
  image_stack(const image_list& list, const std::filesystem::path& folder);

  [[nodiscard]] Eigen::Index rows() const noexcept { return rows_; }
  [[nodiscard]] Eigen::Index columns() const noexcept { return columns_; }

  /// Reflectance in sr^-1 of a range of rows: a column for each image, red, green and blue of a texel after another.
  /// Throws gonio::error naming the image and the texel whose value is not finite.
  [[nodiscard]] Eigen::MatrixXf read(gonio::block rows, gonio::thread_count threads) const;

 private:
  struct source {
    std::string name;
    gonio::io::detail::descriptor file;
    std::uint64_t offset = 0;   ///< of the first number
    std::size_t word_size = 4;  ///< bytes of a number
    float factor = 1.0f;        ///< what makes it sr^-1
  };

  [[nodiscard]] source open_npy(const std::filesystem::path& path);
  [[nodiscard]] source decode(const std::filesystem::path& path, const std::filesystem::path& folder);
  void require_size(const std::string& name, Eigen::Index rows, Eigen::Index columns);
  void read_into(const source& image, gonio::block rows, Eigen::Ref<Eigen::VectorXf> out) const;

  Eigen::Index rows_ = 0, columns_ = 0;
  std::vector<source> sources_;
};

}  // namespace cli
