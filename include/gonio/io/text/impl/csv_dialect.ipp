#pragma once
/// Bodies of io/text/csv_dialect.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/text/csv_dialect.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE csv_dialect dialect_of(std::string_view header) {
  constexpr std::string_view separators = ",;\t";
  std::array<std::size_t, separators.size()> counts{};
  bool in_quotes = false;
  for (const char c : header) {
    if (c == '"') in_quotes = !in_quotes;
    const std::size_t which = separators.find(c);
    if (!in_quotes && which != std::string_view::npos) ++counts[which];
  }
  const auto most = std::ranges::max_element(counts);
  return {*most == 0 ? ' ' : separators[static_cast<std::size_t>(most - counts.begin())]};
}

[[gnu::cold]] GONIO_INLINE std::string description(const csv_dialect& dialect) {
  const char* separated = dialect.separator == ','    ? "comma-separated"
                          : dialect.separator == ';'  ? "semicolon-separated"
                          : dialect.separator == '\t' ? "tab-separated"
                                                      : "separated by blanks";
  const char* marked = dialect.decimal_mark == ','   ? " with decimal commas"
                       : dialect.decimal_mark == '.' ? " with decimal points"
                                                     : "";
  return std::string(separated) + marked;
}

}  // namespace gonio::io

namespace gonio::io::detail {

[[gnu::cold]] GONIO_INLINE void require_no_workbook(std::string_view text, const std::string& name) {
  const bool is_archive = text.starts_with("PK\x03\x04"), is_old_workbook = text.starts_with("\xD0\xCF\x11\xE0");
  if (is_archive || is_old_workbook)
    gonio::refuse({name, ": looks like a workbook of a spreadsheet, expected text: save its sheet as CSV"});
}

/// Takes a field in double quotes from the front of a line. Returns false if the closing quote is missing.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE bool read_quoted(std::string_view& line, std::string_view& field) {
  std::size_t end = line.find('"', 1);
  while (end != std::string_view::npos && line.substr(end + 1).starts_with('"')) end = line.find('"', end + 2);
  if (end == std::string_view::npos) return false;
  field = trimmed(line.substr(1, end - 1));
  line.remove_prefix(end + 1);
  return true;
}

[[gnu::cold]] GONIO_INLINE const char* split_quoted(std::string_view line, char separator,
                                                    std::vector<std::string_view>& fields) {
  const std::string_view ends = separator == ' ' ? blanks : std::string_view(&separator, 1);
  if (separator == ' ') line = trimmed(line);
  fields.clear();
  while (true) {
    // Skip blanks before a field, but not a tab that separates fields.
    line.remove_prefix(std::min(line.find_first_not_of(separator == '\t' ? " " : blanks), line.size()));
    std::string_view field;
    const bool has_quotes = line.starts_with('"');
    if (has_quotes && !read_quoted(line, field)) return "a double quote is not closed on its line";
    const std::string_view rest = line.substr(0, line.find_first_of(ends));
    if (has_quotes && !trimmed(rest).empty()) return "a field continues after its closing double quote";
    fields.push_back(has_quotes ? field : trimmed(rest));
    if (rest.size() == line.size()) return nullptr;
    line.remove_prefix(rest.size() + 1);
  }
}

/// Returns a number without the marks between its groups of three digits; empty if it has no such groups.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::string without_group_marks(std::string_view field) {
  // Group marks are apostrophes, no-break and thin spaces, and a point or a comma if the other of these two follows.
  const std::size_t comma = field.find(','), point = field.find('.');
  const bool has_both = comma != std::string_view::npos && point != std::string_view::npos;
  const std::string_view both = comma < point ? "," : ".";
  const std::array<std::string_view, 7> marks{"'",    "\xE2\x80\x99",       "\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89",
                                              "\xA0", has_both ? both : "'"};
  for (const std::string_view mark : marks) {
    std::string number;
    std::string_view rest = field;
    bool is_grouped = false;
    for (std::size_t end = rest.find(mark); end != std::string_view::npos; end = rest.find(mark)) {
      const std::string_view digits = rest.substr(is_grouped || rest.find_first_of("+-") != 0 ? 0 : 1);
      const std::size_t count = std::min(digits.find_first_not_of("0123456789"), digits.size());
      const bool fits = digits.substr(count).starts_with(mark) && (is_grouped ? count == 3 : count >= 1 && count <= 3);
      if (!fits) return {};
      number += rest.substr(0, end);
      rest.remove_prefix(end + mark.size());
      is_grouped = true;
    }
    if (is_grouped && std::min(rest.find_first_not_of("0123456789"), rest.size()) == 3) return number += rest;
  }
  return {};
}

/// Reads a number that may have a decimal comma or group marks. If the dialect's decimal mark is unknown, sets it.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE const char* read_marked_number(std::string_view field, csv_dialect& dialect,
                                                                        double& value) {
  const std::string grouped = without_group_marks(field);
  if (!grouped.empty()) field = grouped;
  const std::size_t comma = field.find(',');
  const bool has_comma = comma != std::string_view::npos, has_point = field.find('.') != std::string_view::npos;
  if (!has_comma && !has_point) return read_number(field, value);
  if (has_comma && has_point) return " is not a number: it has a point and a comma";
  const char mark = has_comma ? ',' : '.';
  if (dialect.decimal_mark != '?' && dialect.decimal_mark != mark)
    return has_comma ? " has a decimal comma, but a number above has a decimal point"
                     : " has a decimal point, but a number above has a decimal comma";
  const char* wrong = nullptr;
  if (has_comma) {
    std::string with_point(field);
    with_point[comma] = '.';
    wrong = read_number(with_point, value);
  } else {
    wrong = read_number(field, value);
  }
  if (wrong == nullptr) dialect.decimal_mark = mark;
  return wrong;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE const char* csv_dialect::split(std::string_view line, std::vector<std::string_view>& fields) const {
  if (line.find('"') != std::string_view::npos) return detail::split_quoted(line, separator, fields);
  if (separator == ' ')
    split_at_blanks(line, fields);
  else
    split_fields(line, fields, separator);
  return nullptr;
}

GONIO_INLINE const char* csv_dialect::read_number(std::string_view field, double& value) {
  if (decimal_mark != '.') return detail::read_marked_number(field, *this, value);
  const char* wrong = io::read_number(field, value);
  return wrong == nullptr ? wrong : detail::read_marked_number(field, *this, value);
}

}  // namespace gonio::io
