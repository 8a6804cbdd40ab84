#pragma once
/// What a misspelt word was meant to be: a name of a column, an option.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio {

/// The number of letters to insert, delete, replace, or exchange with their neighbour that make one word of another:
/// the distance of Damerau and Levenshtein, without a second change at the same letters. O(product of the lengths).
[[nodiscard]] std::size_t spelling_distance(std::string_view one, std::string_view other);

/// The word that is nearest to a misspelt one, if no more than a third of its letters differ.
[[nodiscard]] std::optional<std::string> nearest_word(std::string_view misspelt, const std::vector<std::string>& words);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/spelling.ipp>
#endif
