#pragma once
/// JSON texts (RFC 8259), read forwards: the caller reads the values that it wants and skips the others. No tree of
/// values is built, and nothing is allocated but what is read.
/// ```
/// json_reader json(text, place);
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
  json_reader(std::string_view text, text_place& place) : text_(without_byte_order_mark(text)), place_(place) {}

  /// `what` is what errors call the value.
  void open_object(std::string_view what) { open('{', "an object", what); }
  void open_array(std::string_view what) { open('[', "an array", what); }

  /// The next key of the object that was opened last, or nothing at its end. Its value must be read before the next.
  [[nodiscard]] std::optional<std::string> next_key();

  /// Is there a next element in the array that was opened last? It must be read before the next.
  [[nodiscard]] bool next_element();

  /// A finite number.
  [[nodiscard]] double read_number(std::string_view what);

  /// A string in UTF-8. A character beyond the basic plane that is escaped becomes two question marks.
  [[nodiscard]] std::string read_string(std::string_view what);

  /// The first character of the next value: one of {["-0123456789tfn if it is one.
  [[nodiscard]] char peek();

  /// Checks a value of any kind, of at most 100 levels, and returns its text.
  std::string_view skip(std::size_t depth = 0);

  /// Refuses whatever follows but blanks.
  void finish();

  /// Refuses what was taken last, by its line.
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
  text_place& place_;
  std::size_t at_ = 0;
  bool is_first_ = false;  ///< what was opened last has given nothing yet
};

}  // namespace gonio::io::detail

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/json_reader.ipp>
#endif
