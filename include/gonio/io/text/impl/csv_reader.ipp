#pragma once
/// Bodies of io/text/csv_reader.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/text/csv_dialect.hpp>
#include <gonio/io/text/csv_reader.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/io/text/utf16.hpp>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

GONIO_INLINE csv_reader::csv_reader(std::string_view text, const std::string& name)
    : left_(without_byte_order_mark(text)), position_{name, 0} {
  detail::require_no_workbook(text, name);
  if (is_utf16(text)) {
    converted_ = std::make_shared<const std::string>(utf8_of_utf16(text));
    left_ = *converted_;
  }
  read_separator();
}

[[gnu::cold]] GONIO_INLINE void csv_reader::read_separator() {
  std::string_view text = left_, line;
  text_position position = position_;
  if (!next_whole_line(text, position, line)) return;
  line = trimmed(line);
  if (line.size() >= 2 && line.front() == '"' && line.back() == '"') line = line.substr(1, line.size() - 2);
  if (line.size() < 4 || lower_case(line.substr(0, 4)) != "sep=") return;
  line.remove_prefix(4);
  separator_ = line.empty() ? '\t' : line.front();  // a tab was trimmed
  if (line.size() > 1 || (separator_ != ',' && separator_ != ';' && separator_ != '\t'))
    position.refuse({in_quotes(line), " is not a separator, expected sep=, or sep=; or sep= and a tab"});
  left_ = text;
  position_ = position;
}

GONIO_INLINE csv_dialect csv_reader::dialect_of_header(std::string_view line) const {
  return separator_ == '\0' ? dialect_of(line) : csv_dialect{separator_};
}

[[gnu::cold]] GONIO_INLINE bool csv_reader::next_if(
    const std::function<bool(const std::vector<std::string_view>&)>& is_it) {
  std::string_view left = left_, line;
  text_position position = position_;
  std::vector<std::string_view> fields;
  if (!next_whole_line(left, position, line) || dialect_.split(line, fields) != nullptr) return false;
  while (fields.size() > columns_ && fields.back().empty()) fields.pop_back();
  if (fields.size() != columns_ || !is_it(fields)) return false;
  left_ = left;
  position_ = position;
  fields_ = fields;
  return true;
}

[[gnu::cold]] GONIO_INLINE bool csv_reader::find_header(
    const std::function<bool(const std::vector<std::string_view>&)>& is_it) {
  constexpr int most_lines = 1000;
  std::string_view left = left_, line;
  text_position position = position_;
  std::vector<std::string_view> fields;
  for (int i = 0; i < most_lines && next_whole_line(left, position, line); ++i) {
    line = trimmed(line);
    if (line.front() == '#' || line.starts_with("\"# ")) continue;
    if (dialect_of_header(line).split(line, fields) != nullptr || !is_it(fields)) continue;
    header_line_ = position.line;
    return true;
  }
  return false;
}

GONIO_INLINE bool csv_reader::next(const std::function<void(std::string_view)>& read_comment) {
  std::string_view line;
  if (!next_line(line, read_comment)) return false;
  if (columns_ == 0) dialect_ = dialect_of_header(line);
  if (const char* wrong = dialect_.split(line, fields_)) position_.refuse(wrong);
  // Spreadsheets pad lines with separators.
  while (fields_.size() > std::max<std::size_t>(columns_, 1) && fields_.back().empty()) fields_.pop_back();
  if (columns_ == 0) columns_ = fields_.size();
  if (fields_.size() != columns_) refuse_size(line);
  return true;
}

/// Reads the next line that is not a comment. Above the header line, a comment may be in quotes, which spreadsheets
/// add. Below it, a quoted text is a field.
GONIO_INLINE bool csv_reader::next_line(std::string_view& line,
                                        const std::function<void(std::string_view)>& read_comment) {
  while (next_whole_line(left_, position_, line)) {
    const std::size_t first = line.find_first_not_of(blanks);
    const bool in_quotes = columns_ == 0 && line.substr(first).starts_with("\"# ");
    if (in_quotes || line[first] == '#') {
      const std::string_view comment = line.substr(first + (in_quotes ? 2 : 1));
      const std::size_t last = comment.find_last_not_of(",;\" \t\r");  // separators added by a spreadsheet
      if (read_comment) read_comment(comment.substr(0, last == std::string_view::npos ? 0 : last + 1));
      continue;
    }
    if (position_.line < header_line_) {
      passed_over_.push_back(trimmed(line));
      continue;
    }
    if ((line[first] != ',' && line[first] != ';') || line.find_first_not_of(",; \t\r") != std::string_view::npos)
      return true;
  }
  return false;
}

[[gnu::cold]] GONIO_INLINE void csv_reader::refuse_size(std::string_view line) const {
  const csv_dialect of_line = dialect_of(line);
  const std::size_t found = fields_.size();
  const bool differs = of_line.separator != dialect_.separator;
  const bool may_have_commas = !differs && dialect_.separator == ',' && found > columns_;
  position_.refuse({found, found == 1 ? " field" : " fields", ", expected ", columns_,
                    " as in the header line; the header line looks ", description({dialect_.separator}),
                    differs ? ", this one " : "", differs ? description(of_line) : "",
                    may_have_commas ? ": separate fields by semicolons if numbers have decimal commas" : ""});
}

}  // namespace gonio::io
