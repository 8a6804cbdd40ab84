#pragma once
/// Bodies of io/text/rules.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/text/rules.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE text_rule read_rule(std::string_view line, const text_position& position) {
  std::vector<std::string_view> words;
  split_at_blanks(line.substr(0, line.find('#')), words);
  text_rule rule;
  for (const std::string_view word : words) {
    if (rule.name.empty())
      rule.name = word;
    else
      rule.numbers.push_back(read_number(word, position, [&] { return "number of " + in_quotes(rule.name); }));
  }
  return rule;
}

GONIO_INLINE void require_numbers(const text_rule& rule, std::initializer_list<std::size_t> counts,
                                  const text_position& position) {
  if (std::ranges::find(counts, rule.numbers.size()) != counts.end()) return;
  std::string expected;
  for (const std::size_t count : counts) expected += (expected.empty() ? "" : " or ") + std::to_string(count);
  position.refuse(in_quotes(rule.name) + " takes " + expected + (expected == "1" ? " number" : " numbers") + ", not " +
                  std::to_string(rule.numbers.size()));
}

}  // namespace gonio::io::detail
