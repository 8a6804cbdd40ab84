#pragma once
/// Bodies of core/printable.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/printable.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace gonio::detail {

/// Returns the number of bytes of the first UTF-8 character; 0 if the text does not begin with a printable one.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::size_t printable_character(std::string_view text) noexcept {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  const std::size_t size = first >= 0xC2 && first <= 0xDF   ? 2
                           : first >> 4 == 0xE              ? 3
                           : first >= 0xF0 && first <= 0xF4 ? 4
                                                            : 0;
  for (std::size_t i = 1; i < size; ++i)
    if (byte(i) >> 6 != 2) return 0;
  const unsigned second = byte(1);
  // C1 controls, overlong forms, surrogates, and code points outside of Unicode.
  const bool wrong = (first == 0xC2 && second < 0xA0) || (first == 0xE0 && second < 0xA0) ||
                     (first == 0xED && second >= 0xA0) || (first == 0xF0 && second < 0x90) ||
                     (first == 0xF4 && second >= 0x90);
  return wrong ? 0 : size;
}

}  // namespace gonio::detail

namespace gonio {

[[gnu::cold]] GONIO_INLINE std::string printable(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string shown;
  while (!text.empty()) {
    const std::size_t size = detail::printable_character(text);
    if (size == 0) {
      const auto byte = static_cast<unsigned char>(text.front());
      shown += {'\\', 'x', digits[byte >> 4], digits[byte & 15u]};
    } else {
      shown += text.substr(0, size);
    }
    text.remove_prefix(size == 0 ? 1 : size);
  }
  return shown;
}

}  // namespace gonio
