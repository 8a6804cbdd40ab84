#pragma once
/// Bodies of shape/io/mesh_parts.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/shape/io/mesh_parts.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE std::string_view read_word(std::string_view& line) noexcept {
  constexpr auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  const auto begin = std::ranges::find_if_not(line, is_blank);
  const auto end = std::ranges::find_if(begin, line.end(), is_blank);
  const std::string_view word(begin, end);
  line = std::string_view(end, line.end());
  return word;
}

GONIO_INLINE void polygon_fan::add(int vertex) {
  if (size_ >= 2) corners_.insert(corners_.end(), {first_, last_, vertex});
  if (size_ == 0) first_ = vertex;
  last_ = vertex;
  ++size_;
}

}  // namespace gonio::io::detail
