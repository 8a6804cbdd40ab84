#pragma once
/// Bodies of io/text/text.hpp.

#include <gonio/core/assertion.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/text/text.hpp>

#include <locale.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>
#include <version>

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE void text_position::refuse(std::initializer_list<message_part> what) const {
  gonio::refuse({name, ", line ", line, ": ", message_of(what)});
}

[[gnu::cold]] GONIO_INLINE std::string in_quotes(std::string_view field) {
  constexpr std::size_t longest = 40;
  std::string text(field.substr(0, longest));
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return message_of({"'", text, field.size() > longest ? "...'" : "'"});
}

GONIO_INLINE std::string_view trimmed(std::string_view text) noexcept {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

[[gnu::cold]] GONIO_INLINE std::string listed(std::span<const std::string_view> words, std::string_view between) {
  std::string all;
  for (const std::string_view word : words) all += message_of({all.empty() ? "" : between, word});
  return all;
}

GONIO_INLINE std::string lower_case(std::string_view text) {
  std::string small(text);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small;
}

GONIO_INLINE std::string_view without_byte_order_mark(std::string_view text) noexcept {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

GONIO_INLINE bool next_whole_line(std::string_view& text, text_position& position, std::string_view& line) {
  while (!text.empty()) {
    ++position.line;
    std::size_t end = std::min(text.find('\n'), text.size());
    // A carriage return without a line feed ends a line, too.
    if (const std::size_t alone = text.substr(0, end).find('\r'); alone != std::string_view::npos && alone + 1 < end)
      end = alone;
    line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.find_first_not_of(blanks) != std::string_view::npos) return true;
  }
  return false;
}

GONIO_INLINE bool next_line(std::string_view& text, text_position& position, std::string_view& line) {
  while (next_whole_line(text, position, line)) {
    line = trimmed(line);
    if (line.front() != '#') return true;
  }
  return false;
}

GONIO_INLINE void split_fields(std::string_view line, std::vector<std::string_view>& fields, char separator) {
  fields.clear();
  for (std::size_t end = line.find(separator); end != std::string_view::npos; end = line.find(separator)) {
    fields.push_back(trimmed(line.substr(0, end)));
    line.remove_prefix(end + 1);
  }
  fields.push_back(trimmed(line));
}

GONIO_INLINE void split_at_blanks(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;
       begin = line.find_first_not_of(blanks)) {
    line.remove_prefix(begin);
    const std::size_t size = std::min(line.find_first_of(blanks), line.size());
    words.push_back(line.substr(0, size));
    line.remove_prefix(size);
  }
}

[[gnu::cold]] GONIO_INLINE std::errc read_by_strtod(std::string_view digits, double& value) {
  // Refuse what strtod accepts and from_chars does not: leading blanks and plus signs, and hexadecimal digits.
  constexpr std::string_view begins = "-.0123456789iInN";
  if (digits.empty() || begins.find(digits.front()) == std::string_view::npos) return std::errc::invalid_argument;
  if (digits.find_first_of("xX") != std::string_view::npos) return std::errc::invalid_argument;
#if defined(_WIN32)
  static const auto plain = ::_create_locale(LC_ALL, "C");
  constexpr auto read = &::_strtod_l;
#else
  static const ::locale_t plain = ::newlocale(LC_ALL_MASK, "C", nullptr);
  constexpr auto read = &::strtod_l;
#endif
  const std::string text(digits);  // zero-terminated, for strtod
  char* end = nullptr;
  errno = 0;
  const double number = read(text.c_str(), &end, plain);
  if (end != text.c_str() + text.size()) return std::errc::invalid_argument;
  if (errno == ERANGE && (number == 0.0 || std::isinf(number))) return std::errc::result_out_of_range;
  value = number;
  return std::errc();
}

[[nodiscard]] GONIO_INLINE std::errc read_whole(std::string_view digits, double& value) {
#if defined(__cpp_lib_to_chars)
  const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return end == digits.data() + digits.size() ? failed : std::errc::invalid_argument;
#else
  return read_by_strtod(digits, value);
#endif
}

GONIO_INLINE const char* read_number(std::string_view field, double& value) {
  // Instruments print plus signs, which from_chars does not accept.
  const bool plus = field.size() > 1 && field[0] == '+' && field[1] != '-';
  const std::string_view digits = field.substr(plus ? 1 : 0);
  const std::errc failed = read_whole(digits, value);
  if (failed == std::errc::result_out_of_range) return " is out of range";
  if (failed != std::errc()) return " is not a number";
  return std::isfinite(value) ? nullptr : " is not finite";
}

GONIO_INLINE std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto [end, failed] = std::to_chars(text.data(), text.data() + text.size(), value);
  GONIO_ASSERT(failed == std::errc());
  return {text.data(), end};
}

}  // namespace gonio::io
