#pragma once
/// How a CSV file separates its fields and writes its numbers, told from the file itself, always in the same way.
/// The separator is the one of comma, semicolon and tab that stands most often in the header line, outside of double
/// quotes (of equals, the first of these); if none does, it is runs of blanks. The decimal mark is that of the first
/// number that has one, a point or a comma: a field of a comma-separated file that holds a comma is in quotes. From
/// then on the other mark is refused, so that 1.234 among decimal commas is not taken for 1234. Thousands may be set
/// apart where that cannot be a decimal mark: 1.081,43 and 1,081.43, 1'081.43, 1 081,43 with a no-break space.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

struct csv_dialect {
  char separator = ',';     ///< a comma, a semicolon, a tab, or a blank for runs of blanks and tabs
  char decimal_mark = '?';  ///< a point, a comma, or ? as long as no number has had one

  /// The fields of a line, trimmed, without the double quotes around them (RFC 4180, but a field ends on its line;
  /// doubled quotes in a field stay doubled). Returns what is wrong with the line, or nothing.
  [[nodiscard]] const char* split(std::string_view line, std::vector<std::string_view>& fields) const;

  /// Reads a finite number; the first with a decimal mark decides which one the file has. Returns what is wrong with
  /// the field, or nothing.
  [[nodiscard]] const char* read_number(std::string_view field, double& value);

  friend bool operator==(const csv_dialect&, const csv_dialect&) = default;
};

/// The dialect of a file with this header line. O(length).
[[nodiscard]] csv_dialect dialect_of(std::string_view header);

/// For people: "semicolon-separated with decimal commas".
[[nodiscard]] std::string description(const csv_dialect& dialect);

namespace detail {

/// Refuses what is often saved instead of CSV, a workbook. `name` is what the sentence calls the file.
void require_no_workbook(std::string_view text, const std::string& name);

}  // namespace detail

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/csv_dialect.ipp>
#endif
