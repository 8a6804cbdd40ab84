#pragma once
/// How a CSV file separates its fields and writes its numbers, derived from the file itself. The separator is the most
/// frequent of comma, semicolon and tab in the header line outside double quotes (in this order if equally frequent).
/// If the line has none of them, runs of blanks separate fields. The first number with a point or a comma sets the
/// decimal mark; later numbers with the other mark are refused: among decimal commas, 1.234 could mean 1234. In a
/// comma-separated file, a field that contains a comma is in quotes. Thousands may be grouped where the group mark
/// cannot be a decimal mark: 1.081,43 and 1,081.43, 1'081.43, 1 081,43 with a no-break space.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

struct csv_dialect {
  char separator = ',';     ///< a comma, a semicolon, a tab, or a blank for runs of blanks and tabs
  char decimal_mark = '?';  ///< a point, a comma, or ? while no number has had one

  /// Splits a line into trimmed fields without their surrounding double quotes (RFC 4180, but a field ends on its line
  /// and doubled quotes in a field stay doubled). Returns the fault of the line, or nullptr.
  [[nodiscard]] const char* split(std::string_view line, std::vector<std::string_view>& fields) const;

  /// Reads a finite number; the first decimal mark sets `decimal_mark`. Returns the fault of the field, or nullptr.
  [[nodiscard]] const char* read_number(std::string_view field, double& value);

  friend bool operator==(const csv_dialect&, const csv_dialect&) = default;
};

/// Returns the dialect of a file with this header line. O(length).
[[nodiscard]] csv_dialect dialect_of(std::string_view header);

/// Returns a description for people: "semicolon-separated with decimal commas".
[[nodiscard]] std::string description(const csv_dialect& dialect);

namespace detail {

/// Refuses a workbook, which is often saved instead of CSV. `name` is the file's name in the error.
void require_no_workbook(std::string_view text, const std::string& name);

}  // namespace detail

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/csv_dialect.ipp>
#endif
