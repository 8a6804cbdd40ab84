#pragma once
/// Bodies of io/text.hpp.

#include <gonio/core/assertion.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/io/file.hpp>
#include <gonio/io/text.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace gonio::io::detail {

GONIO_INLINE void text_place::refuse(const std::string& what) const { throw error{name, ", line ", line, ": ", what}; }

GONIO_INLINE std::string quoted(std::string_view field) {
  constexpr std::size_t longest = 40;
  std::string text(field.substr(0, longest));
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + text + (field.size() > longest ? "...'" : "'");
}

GONIO_INLINE std::string_view trimmed(std::string_view text) noexcept {
  constexpr std::string_view blank = " \t\r";
  const std::size_t begin = text.find_first_not_of(blank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blank) - begin + 1);
}

GONIO_INLINE std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto [end, failed] = std::to_chars(text.data(), text.data() + text.size(), value);
  GONIO_ASSERT(failed == std::errc());
  return {text.data(), end};
}

}  // namespace gonio::io::detail
