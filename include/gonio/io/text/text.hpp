#pragma once
/// Text files of numbers: what their readers and writers have in common. Bad input is refused with its file, line and
/// field.

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

/// Where in which file a reader is, for its errors.
struct text_place {
  std::string name;
  std::size_t line = 0;

  /// The parts of the message, one after the other.
  [[noreturn]] void refuse(std::initializer_list<message_part> what) const;
  [[noreturn]] void refuse(const message_part& what) const { refuse({what}); }
};

/// What may stand around a field. A carriage return ends lines on some systems.
inline constexpr std::string_view blanks = " \t\r";

/// A field in quotes, short and printable whatever a broken file holds.
[[nodiscard]] std::string in_quotes(std::string_view field);

[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// The text with A to Z as small letters, whatever the locale.
[[nodiscard]] std::string lower_case(std::string_view text);

/// The words with `between` them: "red, green", ".exr or .hdr".
[[nodiscard]] std::string listed(std::span<const std::string_view> words, std::string_view between);

[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text) noexcept;

/// The fields of a line between its commas, or another separator, trimmed; what `fields` held before is dropped.
void split_fields(std::string_view line, std::vector<std::string_view>& fields, char separator = ',');

/// The words of a line, which blanks separate; what `words` held before is dropped.
void split_at_blanks(std::string_view line, std::vector<std::string_view>& words);

/// Takes the next line that holds more than blanks off the front of a text; `place` is then there.
[[nodiscard]] bool next_whole_line(std::string_view& text, text_place& place, std::string_view& line);

/// The same, trimmed, without comments, the lines that start with #.
[[nodiscard]] bool next_line(std::string_view& text, text_place& place, std::string_view& line);

/// Calls `use(line)` for each line that holds something, trimmed, `place` being there. Lines that start with # are
/// comments.
template <class Use>
void for_each_line(std::string_view text, text_place& place, Use&& use) {
  text = without_byte_order_mark(text);
  for (std::string_view line; next_line(text, place, line);) use(line);
}

/// std::from_chars of a whole field for standard libraries that have none of floating-point numbers (libc++ before 20).
[[nodiscard]] std::errc read_by_strtod(std::string_view digits, double& value);

/// Reads a finite number. Returns what is wrong with the field, or nothing.
[[nodiscard]] const char* read_number(std::string_view field, double& value);

/// A finite number; `describe()` is what errors call it.
template <class Describe>
[[nodiscard]] double read_number(std::string_view field, const text_place& place, const Describe& describe) {
  double value = 0.0;
  if (const char* wrong = read_number(field, value)) place.refuse({describe(), ": ", in_quotes(field), wrong});
  return value;
}

/// The shortest text that reads back as the same number.
[[nodiscard]] std::string shortest(double value);

[[nodiscard]] inline std::string_view as_text(std::span<const std::byte> bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/text.ipp>
#endif
