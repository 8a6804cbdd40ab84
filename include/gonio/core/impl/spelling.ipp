#pragma once
/// Bodies of core/spelling.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/spelling.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio {

[[gnu::cold]] GONIO_INLINE std::size_t spelling_distance(std::string_view one, std::string_view other) {
  // In a table of distances, row i belongs to the first i letters of `one`. Only three rows are kept.
  std::vector<std::size_t> before_last, last(other.size() + 1), now(other.size() + 1);
  for (std::size_t j = 0; j <= other.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= one.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= other.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (one[i - 1] == other[j - 1] ? 0 : 1);
      now[j] = std::min({replaced, last[j] + 1, now[j - 1] + 1});
      const bool exchanged = i > 1 && j > 1 && one[i - 1] == other[j - 2] && one[i - 2] == other[j - 1];
      if (exchanged) now[j] = std::min(now[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = now;
  }
  return last.back();
}

[[gnu::cold]] GONIO_INLINE std::optional<std::string> nearest_word(std::string_view misspelt,
                                                                   const std::vector<std::string>& words) {
  const std::string* nearest = nullptr;
  std::size_t least = 0;
  for (const std::string& word : words) {
    const std::size_t distance = spelling_distance(misspelt, word);
    if (nearest != nullptr && distance >= least) continue;
    nearest = &word;
    least = distance;
  }
  if (nearest == nullptr || 3 * least > std::max(misspelt.size(), nearest->size())) return {};
  return *nearest;
}

}  // namespace gonio
