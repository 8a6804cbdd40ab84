#pragma once
/// What an image file stores before any meaning is given to it: the counts of a camera that writes such files.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gonio {

/// Three codes of each pixel. Files of one channel have three equal ones.
struct stored_codes {
  std::size_t rows = 0, columns = 0;
  std::uint16_t largest = 255;        ///< that the file can hold: 65535 of a file of 16 bits
  std::vector<std::uint16_t> values;  ///< row by row, red, green and blue of a pixel adjacent

  [[nodiscard]] std::uint16_t at(std::size_t row, std::size_t column, std::size_t channel) const {
    return values[3 * (row * columns + column) + channel];
  }
};

}  // namespace gonio
