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
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

class csv_reader {
 public:
  /// `name` is what errors call the file. UTF-16 is converted; a first line `sep=;` names the separator, as in Excel.
  /// Throws gonio::error if the text is a workbook.
  csv_reader(std::string_view text, const std::string& name);

  /// Turns to the next line, first to the header line, and false at the end. `read_comment` is called with what stands
  /// behind the `#` of each comment above it. Throws gonio::error, with the line, if a double quote is not closed or if
  /// there are other than the header line's fields; empty ones behind those are dropped.
  [[nodiscard]] bool next(const std::function<void(std::string_view)>& read_comment = {});

  /// Takes the next line if it has as many fields as the header line and `is_it` is true of them.
  [[nodiscard]] bool next_if(const std::function<bool(const std::vector<std::string_view>&)>& is_it);

  /// Looks for the header line among the first 1,000: the first whose fields are one by `is_it`. Of a file that has
  /// one, the lines above it are passed over, but for comments. False if there is none.
  bool find_header(const std::function<bool(const std::vector<std::string_view>&)>& is_it);

  /// The lines above the header line that were passed over.
  [[nodiscard]] const std::vector<std::string_view>& passed_over() const noexcept { return passed_over_; }

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
  void read_separator();
  [[nodiscard]] csv_dialect dialect_of_header(std::string_view line) const;
  [[nodiscard]] bool next_line(std::string_view& line, const std::function<void(std::string_view)>& read_comment);
  [[noreturn]] void refuse_size(std::string_view line) const;

  std::shared_ptr<const std::string> converted_;  ///< of UTF-16
  std::string_view left_;
  text_place place_;
  csv_dialect dialect_;
  std::vector<std::string_view> fields_;
  char separator_ = '\0';        ///< that the first line names
  std::size_t columns_ = 0;      ///< of the header line; 0 above it
  std::size_t header_line_ = 0;  ///< 0 if it is the first that is no comment
  std::vector<std::string_view> passed_over_;
};

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/csv_reader.ipp>
#endif
