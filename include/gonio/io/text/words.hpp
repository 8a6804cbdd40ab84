#pragma once
/// Text files of words and numbers, whatever lines they stand in. Comments are lines that start with #, and what
/// follows a word that is # alone.

#include <gonio/io/text/text.hpp>

#include <cstddef>
#include <initializer_list>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// Reads the words of a text one after the other; `place` is then the line of the last one.
class word_reader {
 public:
  word_reader(std::string_view text, text_place& place) : text_(without_byte_order_mark(text)), place_(place) {}

  /// The next word, and it stays there; empty at the end.
  [[nodiscard]] std::string_view peek();

  /// Reads the next word. `what` is what a file that ends before it misses.
  [[nodiscard]] std::string_view read(std::string_view what);

  /// Reads a word that must be one of these; returns which.
  [[nodiscard]] std::size_t read_one_of(std::initializer_list<std::string_view> words);

  /// Reads the next word if it is this one.
  bool read_if(std::string_view word);

  /// A finite number.
  [[nodiscard]] double read_number(std::string_view what);
  /// One from `lowest` to `highest`.
  [[nodiscard]] double read_number(std::string_view what, double lowest, double highest);

  /// A count, at least 1, and as many numbers from `lowest` to `highest`. Memory is asked for as they come.
  [[nodiscard]] std::vector<double> read_list(std::string_view what, double lowest, double highest);

  /// The numbers that stand on the rest of this line, at least one.
  [[nodiscard]] std::vector<double> read_line(std::string_view what, double lowest, double highest);

  /// The words that are left on the line of the last one.
  [[nodiscard]] std::string_view read_rest_of_line();

  /// As many bytes of so many each as follow the line of the last word, whatever they are.
  [[nodiscard]] std::string_view read_bytes(std::size_t count, std::size_t of_each);

  [[nodiscard]] text_place& place() const noexcept { return place_; }

 private:
  [[nodiscard]] bool is_at_end_of_line() const noexcept {
    return line_.empty() || line_ == "#" || line_.starts_with("# ");
  }

  std::string_view text_, line_;
  text_place& place_;
};

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/words.ipp>
#endif
