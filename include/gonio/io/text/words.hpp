#pragma once
/// Text files of words and numbers, read regardless of line breaks. A comment is a line that starts with #, or the rest
/// of a line after the word #.

#include <gonio/io/text/text.hpp>

#include <cstddef>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// Reads the words of a text one after the other and moves `position` to the last word's line.
class word_reader {
 public:
  word_reader(std::string_view text, text_position& position)
      : text_(without_byte_order_mark(text)), position_(position) {}

  /// Returns the next word without reading it; empty at the end.
  [[nodiscard]] std::string_view peek();

  /// Reads the next word. If the file ends first, the error says that it ends before `what`.
  [[nodiscard]] std::string_view read(std::string_view what);

  /// Reads a word that must be one of these; returns its index.
  [[nodiscard]] std::size_t read_one_of(std::initializer_list<std::string_view> words);

  /// Reads the next word if it is `word`; returns whether it was.
  bool read_if(std::string_view word);

  /// Reads a finite number.
  [[nodiscard]] double read_number(std::string_view what);
  /// Reads a number from `lowest` to `highest`.
  [[nodiscard]] double read_number(std::string_view what, double lowest, double highest);

  /// Reads a count, at least 1, then as many numbers from `lowest` to `highest`. Memory grows with the numbers read.
  [[nodiscard]] std::vector<double> read_list(std::string_view what, double lowest, double highest);

  /// Reads the numbers on the rest of the last word's line; at least one must follow.
  [[nodiscard]] std::vector<double> read_line(std::string_view what, double lowest, double highest);

  /// Reads the remaining words on the last word's line.
  [[nodiscard]] std::string_view read_rest_of_line();

  /// Reads `count` times `of_each` bytes of any value, from the beginning of the line after the last word read.
  [[nodiscard]] std::string_view read_bytes(std::size_t count, std::size_t of_each);

  [[nodiscard]] text_position& position() const noexcept { return position_; }

 private:
  [[nodiscard]] bool is_at_end_of_line() const noexcept {
    return line_.empty() || line_ == "#" || line_.starts_with("# ");
  }

  std::string_view text_, line_;
  text_position& position_;
};

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/words.ipp>
#endif
