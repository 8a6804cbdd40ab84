#pragma once
/// Common parts of the readers and writers of text files of numbers. Errors name file, line and field.

#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace gonio::io {

/// A reader's position, for its errors: file and line.
struct text_position {
  std::string name;
  std::size_t line = 0;

  /// Throws gonio::error with the position and the joined parts of the message.
  [[noreturn]] void refuse(std::initializer_list<message_part> what) const;
  [[noreturn]] void refuse(const message_part& what) const { refuse({what}); }
};

/// The blanks around a field. On some systems a carriage return ends lines.
inline constexpr std::string_view blanks = " \t\r";

/// Returns the field in quotes, shortened and made printable in case the file is broken.
[[nodiscard]] std::string in_quotes(std::string_view field);

[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// Returns the text with A to Z in lower case, whatever the locale.
[[nodiscard]] std::string lower_case(std::string_view text);

/// Joins the words with `between`: "red, green", ".exr or .hdr".
[[nodiscard]] std::string listed(std::span<const std::string_view> words, std::string_view between);

[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text) noexcept;

/// Splits a line at its separators into trimmed fields, which replace the content of `fields`.
void split_fields(std::string_view line, std::vector<std::string_view>& fields, char separator = ',');

/// Splits a line at blanks into words, which replace the content of `words`.
void split_at_blanks(std::string_view line, std::vector<std::string_view>& words);

/// Takes the next line that is not blank from the front of a text and moves `position` to it. Returns false at the end.
[[nodiscard]] bool next_whole_line(std::string_view& text, text_position& position, std::string_view& line);

/// Takes the next line that is neither blank nor a comment (#) from the front of a text, trims it, and moves `position`
/// to it. Returns false at the end.
[[nodiscard]] bool next_line(std::string_view& text, text_position& position, std::string_view& line);

/// Calls `use(line)` with each trimmed line that is neither blank nor a comment (#), after moving `position` to it.
template <class Use>
void for_each_line(std::string_view text, text_position& position, Use&& use) {
  text = without_byte_order_mark(text);
  for (std::string_view line; next_line(text, position, line);) use(line);
}

/// std::from_chars of a whole field, for standard libraries without the floating-point version (libc++ before 20).
[[nodiscard]] std::errc read_by_strtod(std::string_view digits, double& value);

/// Reads a finite number. Returns the fault of the field, or nullptr.
[[nodiscard]] const char* read_number(std::string_view field, double& value);

/// Reads a finite number. Throws gonio::error naming `position`, with `describe()` as the number's name.
template <class Describe>
[[nodiscard]] double read_number(std::string_view field, const text_position& position, const Describe& describe) {
  double value = 0.0;
  if (const char* wrong = read_number(field, value)) position.refuse({describe(), ": ", in_quotes(field), wrong});
  return value;
}

/// Returns the shortest text that reads back as the same number.
[[nodiscard]] std::string shortest(double value);

[[nodiscard]] inline std::string_view as_text(std::span<const std::byte> bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/text.ipp>
#endif
