#pragma once
/// Text files of rules. Each line is a name and its numbers, separated by blanks; a comment starts with #.

#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// A line of the file: the rule's name and its numbers. The name is a view into the text.
struct text_rule {
  std::string_view name;
  std::vector<double> numbers;
};

[[nodiscard]] text_rule read_rule(std::string_view line, const text_position& position);

/// Throws gonio::error unless the rule has one of these counts of numbers.
void require_numbers(const text_rule& rule, std::initializer_list<std::size_t> counts, const text_position& position);

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/rules.ipp>
#endif
