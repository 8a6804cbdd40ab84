#pragma once
/// Text files of numbers: what their readers and writers have in common. Bad input is refused with its file, line and
/// field.

#include <gonio/core/assertion.hpp>
#include <gonio/io/file.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace gonio::io::detail {

/// Where in which file a reader is, for its errors.
struct text_place {
  std::string name;
  std::size_t line = 0;

  [[noreturn]] void refuse(const std::string& what) const;
};

/// A field in quotes, short and printable whatever a broken file holds.
[[nodiscard]] std::string quoted(std::string_view field);

[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// Calls `use(line)` for each line that holds something, trimmed, `place` being there. Lines that start with # are
/// comments.
template <class Use>
void for_each_line(std::string_view text, text_place& place, Use&& use) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  while (!text.empty()) {
    ++place.line;
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (!line.empty() && line.front() != '#') use(line);
  }
}

/// A finite number; `describe()` is what errors call it.
template <class Describe>
[[nodiscard]] double parse_number(std::string_view field, const text_place& place, const Describe& describe) {
  const auto refuse = [&](const char* what) { place.refuse(describe() + ": " + quoted(field) + what); };
  // Instruments print a plus sign, which from_chars does not know.
  const bool plus = field.size() > 1 && field[0] == '+' && field[1] != '-';
  const std::string_view digits = field.substr(plus ? 1 : 0);
  double value = 0.0;
  const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (failed == std::errc::result_out_of_range) refuse(" is out of range");
  if (failed != std::errc() || end != digits.data() + digits.size()) refuse(" is not a number");
  if (!std::isfinite(value)) refuse(" is not finite");
  return value;
}

/// The shortest text that reads back as the same number.
[[nodiscard]] std::string shortest(double value);

[[nodiscard]] inline std::string_view as_text(std::span<const std::byte> bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/text.ipp>
#endif
