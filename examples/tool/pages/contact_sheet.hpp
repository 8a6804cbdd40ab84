#pragma once
/// Images of one size in rows, with a label under each and a caption under all.

#include <gonio/render/image.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace cli {

/// What is written on a contact sheet, grey on black.
struct sheet_text {
  std::vector<std::string> labels;  ///< one for each image, or none
  std::string caption;              ///< broken into lines where a line is full
};

/// The images row by row, `columns` in each row. A label that is wider than its image ends in "...".
[[nodiscard]] gonio::image contact_sheet(std::span<const gonio::image> images, std::size_t columns,
                                         const sheet_text& text = {});

}  // namespace cli
