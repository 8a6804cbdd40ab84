#pragma once
/// The numbers that an image file stores, before interpretation: the counts of a camera that writes such files.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gonio {

/// Three codes for each pixel. For files of one channel, all three are equal.
struct stored_codes {
  std::size_t rows = 0, columns = 0;
  std::uint16_t largest = 255;        ///< the largest code of the file: 65535 for 16 bits
  std::vector<std::uint16_t> values;  ///< row by row, red, green and blue of a pixel adjacent

  [[nodiscard]] std::uint16_t at(std::size_t row, std::size_t column, std::size_t channel) const {
    return values[3 * (row * columns + column) + channel];
  }
};

}  // namespace gonio
