#pragma once
/// Guesses the intended word of a misspelt one, such as the name of a column or an option.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio {

/// Returns the number of letters to insert, delete, replace, or exchange with their neighbour to change one word into
/// another: the Damerau-Levenshtein distance, without a second change at the same letters. O(product of the lengths).
[[nodiscard]] std::size_t spelling_distance(std::string_view one, std::string_view other);

/// Returns the word nearest to a misspelt one, if no more than a third of its letters differ.
[[nodiscard]] std::optional<std::string> nearest_word(std::string_view misspelt, const std::vector<std::string>& words);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/spelling.ipp>
#endif
