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

/// What a list of images says (JSON; docs/reference/formats.md).
struct image_list {
  gonio::io::sample_quantity quantity = gonio::io::sample_quantity::brdf;
  std::vector<listed_image> images;
  std::filesystem::path mask;  ///< a PNG, black where texels are not of the sample; none if empty
  bool skips_invalid = false;  ///< texels that have a value that is not finite in an image are not of the sample
};

/// Throws gonio::error naming the list and the image of it that is not what it should be.
[[nodiscard]] image_list read_image_list(const std::filesystem::path& path);

}  // namespace cli
