#pragma once
/// Lists of registered images of a flat sample, one for each pair of directions (docs/reference/formats.md).

#include <gonio/core/direction.hpp>
#include <gonio/io/measurements/sample_quantity.hpp>

#include <filesystem>
#include <vector>

namespace cli {

struct listed_image {
  std::filesystem::path file;
  gonio::direction_pair at;
};

/// The content of a list of images (JSON; docs/reference/formats.md).
struct image_list {
  gonio::io::sample_quantity quantity = gonio::io::sample_quantity::brdf;
  std::vector<listed_image> images;
  std::filesystem::path mask;  ///< a PNG, black outside the sample; empty: none
  bool skips_invalid = false;  ///< texels with a value that is not finite in an image are outside the sample
};

/// Throws gonio::error naming the list and its invalid image.
[[nodiscard]] image_list read_image_list(const std::filesystem::path& path);

}  // namespace cli
