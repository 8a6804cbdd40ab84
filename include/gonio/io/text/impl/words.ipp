#pragma once
/// Bodies of io/text/words.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/io/text/words.hpp>

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE std::string_view word_reader::peek() {
  while (is_at_end_of_line())
    if (!next_line(text_, position_, line_)) return line_ = {};  // the last line may be a comment
  return line_.substr(0, line_.find_first_of(" \t"));
}

GONIO_INLINE std::string_view word_reader::read(std::string_view what) {
  const std::string_view word = peek();
  if (word.empty()) gonio::refuse({position_.name, ": ends before ", what});
  line_ = trimmed(line_.substr(word.size()));
  return word;
}

GONIO_INLINE std::size_t word_reader::read_one_of(std::initializer_list<std::string_view> words) {
  const std::string expected = listed({words.begin(), words.size()}, " or ");
  const std::string_view word = read(expected);
  const auto* const found = std::ranges::find(words, word);
  if (found == words.end()) position_.refuse({in_quotes(word), ", expected ", expected});
  return found - words.begin();
}

GONIO_INLINE bool word_reader::read_if(std::string_view word) {
  if (peek() != word) return false;
  static_cast<void>(read(word));
  return true;
}

GONIO_INLINE double word_reader::read_number(std::string_view what) {
  const std::string_view word = read(what);
  return io::read_number(word, position_, [&] { return std::string(what); });
}

GONIO_INLINE double word_reader::read_number(std::string_view what, double lowest, double highest) {
  const std::string_view word = read(what);
  const double number = io::read_number(word, position_, [&] { return std::string(what); });
  if (!(number >= lowest && number <= highest))
    position_.refuse({what, ": ", in_quotes(word), ", expected from ", shortest(lowest), " to ", shortest(highest)});
  return number;
}

GONIO_INLINE std::vector<double> word_reader::read_list(std::string_view what, double lowest, double highest) {
  const double count = read_number(what);
  if (!(count >= 1.0 && count <= 1e6 && count == static_cast<double>(static_cast<std::size_t>(count))))
    position_.refuse({what, ": ", shortest(count), " is not a count from 1 to 1000000"});
  std::vector<double> numbers;
  while (static_cast<double>(numbers.size()) < count) numbers.push_back(read_number(what, lowest, highest));
  return numbers;
}

GONIO_INLINE std::vector<double> word_reader::read_line(std::string_view what, double lowest, double highest) {
  std::vector<double> numbers;
  do {
    numbers.push_back(read_number(what, lowest, highest));
  } while (!is_at_end_of_line());
  return numbers;
}

GONIO_INLINE std::string_view word_reader::read_rest_of_line() { return std::exchange(line_, {}); }

GONIO_INLINE std::string_view word_reader::read_bytes(std::size_t count, std::size_t of_each) {
  line_ = {};
  if (count > text_.size() / of_each)
    gonio::refuse({position_.name, ": has ", text_.size(), " bytes after line ", position_.line, ", expected ", count,
                   " times ", of_each});
  const std::string_view bytes = text_.substr(0, count * of_each);
  text_.remove_prefix(bytes.size());
  return bytes;
}

}  // namespace gonio::io::detail
