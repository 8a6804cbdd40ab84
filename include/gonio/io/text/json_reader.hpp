#pragma once
/// JSON texts (RFC 8259), read forwards: the caller reads the values that it wants and skips the others. Builds no tree
/// of values and allocates only the strings that are read.
/// ```
/// json_reader json(text, position);
/// json.open_object("file");
/// while (const auto key = json.next_key())
///   if (*key == "angle") angle = json.read_number("angle"); else json.skip();
/// json.finish();
/// ```

#include <gonio/core/error.hpp>
#include <gonio/io/text/text.hpp>

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io::detail {

class json_reader {
 public:
  json_reader(std::string_view text, text_position& position)
      : text_(without_byte_order_mark(text)), position_(position) {}

  /// Enters an object. Errors call the object `what`.
  void open_object(std::string_view what) { open('{', "an object", what); }
  void open_array(std::string_view what) { open('[', "an array", what); }

  /// Returns the next key of the innermost open object, or nothing at its end. Read its value before the next key.
  [[nodiscard]] std::optional<std::string> next_key();

  /// Does the innermost open array have a next element? Read it before the next call.
  [[nodiscard]] bool next_element();

  /// Reads a finite number.
  [[nodiscard]] double read_number(std::string_view what);

  /// Reads a string into UTF-8. An escaped character outside the basic multilingual plane becomes two question marks.
  [[nodiscard]] std::string read_string(std::string_view what);

  /// Returns the first character of the next value without reading it; for a valid value, one of {["-0123456789tfn.
  [[nodiscard]] char peek();

  /// Skips a value of any kind with at most 100 levels, checks it and returns its text.
  std::string_view skip(std::size_t depth = 0);

  /// Throws gonio::error if anything but blanks follows.
  void finish();

  /// Throws gonio::error naming the line of the last value read.
  [[noreturn]] void refuse(std::initializer_list<message_part> what) const;

 private:
  void open(char bracket, std::string_view kind, std::string_view what);
  [[nodiscard]] bool next(char closing);
  void skip_blanks();
  void expect(char c);
  void append_escaped(std::string& string);
  [[nodiscard]] unsigned read_code();
  [[nodiscard]] std::string_view read_literal();

  std::string_view text_;
  text_position& position_;
  std::size_t at_ = 0;
  bool is_first_ = false;  ///< nothing has been read from the innermost object or array yet
};

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/json_reader.ipp>
#endif
