#pragma once
/// Bodies of io/images/pnm.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/images/pnm.hpp>
#include <gonio/io/text/text.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// Takes the next whole number, of at most five digits, from a Netpbm header; skips blanks and comments before it.
[[nodiscard]] GONIO_INLINE std::size_t read_pnm_number(std::string_view& text, const std::string& name) {
  constexpr std::string_view blank = " \t\n\v\f\r";
  while (!text.empty() && (blank.find(text.front()) != std::string_view::npos || text.front() == '#')) {
    const std::size_t end = text.front() == '#' ? text.find('\n') : 0;
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  std::size_t number = 0, digits = 0;
  for (; digits < text.size() && text[digits] >= '0' && text[digits] <= '9'; ++digits) {
    if (digits == 5) gonio::refuse({name, ": a number of the Netpbm header has more than five digits"});
    number = 10 * number + static_cast<std::size_t>(text[digits] - '0');
  }
  if (digits == 0) gonio::refuse({name, ": the Netpbm header is truncated or lacks a number"});
  text.remove_prefix(digits);
  return number;
}

/// Copies the counts of whole pixels: one byte each, or two, the high byte first.
GONIO_INLINE void copy_pnm_counts(std::span<const std::byte> bytes, std::size_t channels, stored_codes& codes,
                                  const std::string& name) {
  const std::size_t width = codes.largest > 255 ? 2 : 1;
  codes.values.resize(3 * codes.rows * codes.columns);
  for (std::size_t i = 0; i < codes.values.size(); ++i) {
    const std::byte* stored = bytes.data() + width * (channels == 3 ? i : i / 3);
    unsigned count = 0;
    for (std::size_t k = 0; k < width; ++k) count = count << 8 | std::to_integer<unsigned>(stored[k]);
    if (count > codes.largest)
      gonio::refuse({name, ": pixel (row ", i / 3 / codes.columns, ", column ", i / 3 % codes.columns, ") counts ",
                     count, ", more than the largest count in its header, ", unsigned{codes.largest}});
    codes.values[i] = static_cast<std::uint16_t>(count);
  }
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE stored_codes read_pnm(std::span<const std::byte> bytes, const std::string& name) {
  std::string_view text = as_text(bytes);
  if (!text.starts_with("P6") && !text.starts_with("P5"))
    gonio::refuse({name, ": is not a binary PPM or PGM file (P6 or P5)"});
  const std::size_t channels = text[1] == '6' ? 3 : 1;
  text.remove_prefix(2);
  stored_codes codes;
  codes.columns = detail::read_pnm_number(text, name);
  codes.rows = detail::read_pnm_number(text, name);
  const std::size_t largest = detail::read_pnm_number(text, name);
  constexpr std::size_t most = 16384;
  if (codes.rows < 1 || codes.columns < 1 || codes.rows > most || codes.columns > most)
    gonio::refuse(
        {name, ": an image of ", codes.columns, " x ", codes.rows, " pixels, expected from 1 to ", most, " each way"});
  if (largest < 1 || largest > 65535)
    gonio::refuse({name, ": the largest count is ", largest, ", expected from 1 to 65535"});
  codes.largest = static_cast<std::uint16_t>(largest);
  // One blank ends the header; the size of the rest is known.
  if (text.empty()) gonio::refuse({name, ": the Netpbm file is truncated"});
  const std::size_t expected = codes.rows * codes.columns * channels * (largest > 255 ? 2 : 1);
  if (text.size() - 1 != expected)
    gonio::refuse({name, ": has ", text.size() - 1, " bytes of pixels, expected ", expected, " for ", codes.columns,
                   " x ", codes.rows, " pixels"});
  detail::copy_pnm_counts(std::as_bytes(std::span(text.substr(1))), channels, codes, name);
  return codes;
}

GONIO_INLINE stored_codes read_pnm(const std::filesystem::path& path) {
  return read_pnm(read_bytes(path), path.string());
}

GONIO_INLINE void write_pnm(const std::filesystem::path& path, const stored_codes& codes) {
  if (codes.values.size() != 3 * codes.rows * codes.columns)
    gonio::refuse({path.string(), ": ", codes.values.size(), " counts, expected three for each of ", codes.columns,
                   " x ", codes.rows, " pixels"});
  const std::string header = message_of({"P6\n", codes.columns, " ", codes.rows, "\n", int{codes.largest}, "\n"});
  std::vector<std::byte> bytes;
  bytes.reserve(header.size() + 2 * codes.values.size());
  for (const char each : header) bytes.push_back(static_cast<std::byte>(each));
  for (const std::uint16_t count : codes.values) {
    if (count > codes.largest)
      gonio::refuse({path.string(), ": a count of ", int{count}, " is above the largest, ", int{codes.largest}});
    if (codes.largest > 255) bytes.push_back(static_cast<std::byte>(count >> 8));
    bytes.push_back(static_cast<std::byte>(count & 0xFF));
  }
  write_atomically(path, bytes);
}

}  // namespace gonio::io
