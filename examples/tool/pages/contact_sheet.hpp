#pragma once
/// Images of one size in rows, with a label under each and a caption at the bottom.

#include <gonio/render/image.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace cli {

/// The text on a contact sheet, grey on black.
struct sheet_text {
  std::vector<std::string> labels;  ///< one for each image, or none
  std::string caption;              ///< broken into lines
};

/// Draws the images row by row, `columns` per row. A label wider than its image is shortened and ends in "...".
[[nodiscard]] gonio::image contact_sheet(std::span<const gonio::image> images, std::size_t columns,
                                         const sheet_text& text = {});

}  // namespace cli
