#pragma once
/// Bodies of io/text/json_reader.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/text/json_reader.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace gonio::io::detail {

GONIO_INLINE void json_reader::refuse(std::initializer_list<message_part> what) const {
  position_.line = 1 + std::ranges::count(text_.substr(0, at_), '\n');
  position_.refuse(what);
}

GONIO_INLINE void json_reader::skip_blanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

GONIO_INLINE char json_reader::peek() {
  skip_blanks();
  if (at_ == text_.size()) gonio::refuse({position_.name, ": the JSON text is cut off"});
  return text_[at_];
}

GONIO_INLINE void json_reader::expect(char c) {
  if (peek() != c) refuse({in_quotes(text_.substr(at_, 1)), ", expected ", in_quotes(std::string_view(&c, 1))});
  ++at_;
}

GONIO_INLINE void json_reader::open(char bracket, std::string_view kind, std::string_view what) {
  if (peek() != bracket) refuse({what, ": expected ", kind});
  ++at_;
  is_first_ = true;
}

GONIO_INLINE bool json_reader::next(char closing) {
  const bool is_first = std::exchange(is_first_, false);
  if (peek() == closing) {
    ++at_;
    return false;
  }
  if (!is_first) expect(',');
  return true;
}

GONIO_INLINE std::optional<std::string> json_reader::next_key() {
  if (!next('}')) return std::nullopt;
  std::string key = read_string("a key");
  expect(':');
  return key;
}

GONIO_INLINE bool json_reader::next_element() { return next(']'); }

GONIO_INLINE std::string_view json_reader::read_literal() {
  skip_blanks();
  const std::size_t begin = at_;
  at_ = std::min(text_.find_first_of(" \t\r\n,:]}[{\"", at_), text_.size());
  return text_.substr(begin, at_ - begin);
}

GONIO_INLINE double json_reader::read_number(std::string_view what) {
  const std::string_view literal = read_literal();
  double number = 0.0;
  const bool begins_well = !literal.empty() && (literal[0] == '-' || (literal[0] >= '0' && literal[0] <= '9'));
  if (!begins_well) refuse({what, ": ", in_quotes(literal), " is not a number"});
  if (const char* wrong = io::read_number(literal, number)) refuse({what, ": ", in_quotes(literal), wrong});
  return number;
}

GONIO_INLINE std::string json_reader::read_string(std::string_view what) {
  if (peek() != '"') refuse({what, ": expected a string"});
  ++at_;
  std::string string;
  while (at_ < text_.size() && text_[at_] != '"') {
    const char c = text_[at_++];
    if (c >= '\0' && c < ' ') refuse({what, ": a control character in a string"});
    if (c == '\\')
      append_escaped(string);
    else
      string += c;
  }
  if (at_ == text_.size()) gonio::refuse({position_.name, ": the JSON text is cut off"});
  ++at_;
  return string;
}

GONIO_INLINE unsigned json_reader::read_code() {
  const std::string_view digits = text_.substr(std::min(at_, text_.size()), 4);
  unsigned code = 0;
  const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
  if (digits.size() != 4 || failed != std::errc() || end != digits.data() + 4)
    refuse({in_quotes(digits), " after \\u, expected four hexadecimal digits"});
  at_ += 4;
  return code;
}

GONIO_INLINE void json_reader::append_escaped(std::string& string) {
  constexpr std::string_view names = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
  const char name = at_ < text_.size() ? text_[at_++] : '\0';
  if (const std::size_t known = names.find(name); known != std::string_view::npos) {
    string += meanings[known];
    return;
  }
  if (name != 'u') refuse({in_quotes(std::string_view(&name, 1)), " after a backslash"});
  const unsigned code = read_code();
  const auto put = [&](unsigned byte) { string += static_cast<char>(byte); };
  if (code < 0x80u) {
    put(code);
  } else if (code < 0x800u) {
    put(0xC0u | code >> 6);
    put(0x80u | (code & 0x3Fu));
  } else if (code >= 0xD800u && code < 0xE000u) {
    put('?');  // half of a surrogate pair
  } else {
    put(0xE0u | code >> 12);
    put(0x80u | (code >> 6 & 0x3Fu));
    put(0x80u | (code & 0x3Fu));
  }
}

GONIO_INLINE std::string_view json_reader::skip(std::size_t depth) {
  if (depth == 100) refuse({"more than 100 levels of arrays and objects"});
  const char first = peek();
  const std::size_t begin = at_;
  if (first == '{') {
    open_object("a value");
    while (next_key()) skip(depth + 1);
  } else if (first == '[') {
    open_array("a value");
    while (next_element()) skip(depth + 1);
  } else if (first == '"') {
    static_cast<void>(read_string("a value"));
  } else if (first == 't' || first == 'f' || first == 'n') {
    const std::string_view literal = read_literal();
    if (literal != "true" && literal != "false" && literal != "null")
      refuse({in_quotes(literal), " is not a JSON value"});
  } else {
    static_cast<void>(read_number("a value"));
  }
  return text_.substr(begin, at_ - begin);
}

GONIO_INLINE void json_reader::finish() {
  skip_blanks();
  if (at_ < text_.size()) refuse({in_quotes(text_.substr(at_, 1)), " follows the JSON value"});
}

}  // namespace gonio::io::detail
