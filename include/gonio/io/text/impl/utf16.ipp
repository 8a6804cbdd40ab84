#pragma once
/// Bodies of io/text/utf16.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/text/utf16.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace gonio::io::detail {

[[gnu::cold]] GONIO_INLINE void append_utf8(std::string& text, std::uint32_t code) {
  const auto append = [&](std::uint32_t byte) { text += static_cast<char>(static_cast<unsigned char>(byte)); };
  if (code < 0x80) return append(code);
  if (code < 0x800) {
    append(0xC0 | (code >> 6));
  } else if (code < 0x10000) {
    append(0xE0 | (code >> 12));
    append(0x80 | ((code >> 6) & 0x3F));
  } else {
    append(0xF0 | (code >> 18));
    append(0x80 | ((code >> 12) & 0x3F));
    append(0x80 | ((code >> 6) & 0x3F));
  }
  append(0x80 | (code & 0x3F));
}

[[nodiscard]] GONIO_INLINE bool is_big_endian_utf16(std::string_view text) noexcept {
  return text.starts_with("\xFE\xFF") || text.front() == '\0';
}

}  // namespace gonio::io::detail

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE bool is_utf16(std::string_view text) noexcept {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
  if (text.size() < 4) return false;
  const auto alternate = [&](std::size_t zero) {
    return text[zero] == '\0' && text[zero + 2] == '\0' && text[1 - zero] != '\0' && text[3 - zero] != '\0';
  };
  return alternate(0) || alternate(1);
}

[[gnu::cold]] GONIO_INLINE std::string utf8_of_utf16(std::string_view text) {
  constexpr std::uint32_t unknown = 0xFFFD, high = 0xD800, low = 0xDC00, mark = 0xFEFF;
  const bool is_big = detail::is_big_endian_utf16(text);
  const auto unit = [&](std::size_t i) {
    const std::uint32_t first = static_cast<unsigned char>(text[i]), second = static_cast<unsigned char>(text[i + 1]);
    return is_big ? first << 8 | second : second << 8 | first;
  };
  std::string converted;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (i == 0 && code == mark) continue;
    if (code >= high && code < low && i + 3 < text.size() && (unit(i + 2) & 0xFC00) == low) {
      code = 0x10000 + ((code - high) << 10) + (unit(i + 2) - low);
      i += 2;
    } else if (code >= high && code < 0xE000) {
      code = unknown;
    }
    detail::append_utf8(converted, code);
  }
  return converted;
}

}  // namespace gonio::io
