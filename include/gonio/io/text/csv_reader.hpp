#pragma once
/// Reads the lines of a CSV file of any dialect as fields; the readers of samples, tables and lists use this one class.
/// Comments start with `#`. Lines of separators only, which spreadsheets write, are skipped.
/// ```
/// csv_reader csv(text, name);
/// if (csv.next()) use_header(csv.fields());
/// while (csv.next())
///   for (const std::string_view field : csv.fields())
///     if (const char* wrong = csv.read_number(field, number)) csv.position().refuse({in_quotes(field), wrong});
/// ```

#include <gonio/io/text/csv_dialect.hpp>
#include <gonio/io/text/text.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

class csv_reader {
 public:
  /// Converts UTF-16. A first line `sep=;` sets the separator, as in Excel. Errors call the file `name`. Throws
  /// gonio::error if the text is a workbook.
  csv_reader(std::string_view text, const std::string& name);

  /// Moves to the next line, on the first call to the header line; returns false at the end. Calls `read_comment` with
  /// the text after the `#` of each comment above the line. Drops surplus empty fields at the line's end. Throws
  /// gonio::error naming the line if a double quote is not closed or the number of fields is not the header line's.
  [[nodiscard]] bool next(const std::function<void(std::string_view)>& read_comment = {});

  /// Moves to the next line if it has as many fields as the header line and `is_it` returns true for them.
  [[nodiscard]] bool next_if(const std::function<bool(const std::vector<std::string_view>&)>& is_it);

  /// Searches the first 1,000 lines for the header line: the first line whose fields satisfy `is_it`. Returns false if
  /// there is none. Otherwise next() passes over the lines above it, except comments.
  bool find_header(const std::function<bool(const std::vector<std::string_view>&)>& is_it);

  /// Returns the lines above the header line that were passed over.
  [[nodiscard]] const std::vector<std::string_view>& passed_over() const noexcept { return passed_over_; }

  /// Returns the line's fields, trimmed and without quotes.
  [[nodiscard]] const std::vector<std::string_view>& fields() const noexcept { return fields_; }

  /// Reads a finite number in the file's dialect. The first decimal mark sets `dialect().decimal_mark`. Returns the
  /// field's fault, or nullptr.
  [[nodiscard]] const char* read_number(std::string_view field, double& value) {
    // Fast path: nearly all numbers are plain with a decimal point.
    if (dialect_.decimal_mark == '.' && io::read_number(field, value) == nullptr) return nullptr;
    return dialect_.read_number(field, value);
  }

  [[nodiscard]] const csv_dialect& dialect() const noexcept { return dialect_; }
  [[nodiscard]] const text_position& position() const noexcept { return position_; }

 private:
  void read_separator();
  [[nodiscard]] csv_dialect dialect_of_header(std::string_view line) const;
  [[nodiscard]] bool next_line(std::string_view& line, const std::function<void(std::string_view)>& read_comment);
  [[noreturn]] void refuse_size(std::string_view line) const;

  std::shared_ptr<const std::string> converted_;  ///< the text in UTF-8 if the file was UTF-16
  std::string_view left_;
  text_position position_;
  csv_dialect dialect_;
  std::vector<std::string_view> fields_;
  char separator_ = '\0';        ///< set by a first line `sep=;`, or 0
  std::size_t columns_ = 0;      ///< number of fields of the header line; 0 above it
  std::size_t header_line_ = 0;  ///< 0: the first line that is not a comment
  std::vector<std::string_view> passed_over_;
};

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/csv_reader.ipp>
#endif
