#pragma once
/// The lines of a CSV file as fields, whatever their dialect: samples, tables and lists are read through this one
/// class. Comments start with `#`; lines of separators alone, which spreadsheets write, are none.
/// ```
/// csv_reader csv(text, name);
/// if (csv.next()) use_header(csv.fields());
/// while (csv.next())
///   for (const std::string_view field : csv.fields())
///     if (const char* wrong = csv.read_number(field, number)) csv.place().refuse({in_quotes(field), wrong});
/// ```

#include <gonio/io/text/csv_dialect.hpp>
#include <gonio/io/text/text.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

class csv_reader {
 public:
  /// `name` is what errors call the file. Throws gonio::error if the text is a workbook or UTF-16.
  csv_reader(std::string_view text, const std::string& name);

  /// Turns to the next line, first to the header line, and false at the end. `read_comment` is called with what stands
  /// behind the `#` of each comment above it. Throws gonio::error, with the line, if a double quote is not closed or if
  /// there are other than the header line's fields; empty ones behind those are dropped.
  [[nodiscard]] bool next(const std::function<void(std::string_view)>& read_comment = {});

  /// Of the line, trimmed and without quotes.
  [[nodiscard]] const std::vector<std::string_view>& fields() const noexcept { return fields_; }

  /// Reads a finite number in the file's dialect, whose decimal mark the first one with such a mark tells. Returns what
  /// is wrong with the field, or nothing.
  [[nodiscard]] const char* read_number(std::string_view field, double& value) {
    // A plain number with a decimal point, which nearly all are, is read at once.
    if (dialect_.decimal_mark == '.' && io::read_number(field, value) == nullptr) return nullptr;
    return dialect_.read_number(field, value);
  }

  [[nodiscard]] const csv_dialect& dialect() const noexcept { return dialect_; }
  [[nodiscard]] const text_place& place() const noexcept { return place_; }

 private:
  [[nodiscard]] bool next_line(std::string_view& line, const std::function<void(std::string_view)>& read_comment);
  [[noreturn]] void refuse_size(std::string_view line) const;

  std::string_view left_;
  text_place place_;
  csv_dialect dialect_;
  std::vector<std::string_view> fields_;
  std::size_t columns_ = 0;  ///< of the header line; 0 above it
};

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/csv_reader.ipp>
#endif
