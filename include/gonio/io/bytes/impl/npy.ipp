#pragma once
/// Bodies of io/bytes/npy.hpp.

#include <gonio/core/arrays.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/bytes/npy.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE npy_layout npy_header_reader::read() {
  expect('{');
  while (!accept('}')) {
    read_entry();
    if (accept(',')) continue;
    expect('}');
    break;
  }
  skip_blanks();
  if (!text_.empty()) refuse("expected nothing after the dictionary");
  if (!descr_) refuse("the key 'descr' is missing");
  if (!order_) refuse("the key 'fortran_order' is missing");
  if (!shape_) refuse("the key 'shape' is missing");
  return layout();
}

GONIO_INLINE void npy_header_reader::read_entry() {
  const std::string_view key = quoted_text();
  expect(':');
  if (key == "descr" && !descr_)
    descr_ = quoted_text();
  else if (key == "fortran_order" && !order_)
    order_ = boolean();
  else if (key == "shape" && !shape_)
    shape_ = tuple();
  else
    refuse("the key '" + std::string(key) + "' is unknown or appears twice");
}

GONIO_INLINE npy_layout npy_header_reader::layout() const {
  if (*descr_ != "<f2" && *descr_ != "<f4" && *descr_ != "<f8")
    refuse("holds elements of type '" + std::string(*descr_) +
           "', expected '<f2', '<f4' or '<f8' (little-endian floats)");
  if (*order_) refuse("holds an array in Fortran order, expected C order (numpy.ascontiguousarray makes it so)");
  npy_layout found{static_cast<std::size_t>(descr_->back() - '0'), *shape_};
  constexpr std::size_t most = std::numeric_limits<std::ptrdiff_t>::max() / 8;
  // An extent of 0 must not hide that the product of all other extents overflows.
  std::size_t product = 1;
  for (const std::size_t extent : found.shape) {
    const std::size_t factor = std::max<std::size_t>(extent, 1);
    if (product > most / factor) refuse("the product of the shape is too large");
    product *= factor;
    found.count *= extent;
  }
  return found;
}

GONIO_INLINE std::string_view npy_header_reader::quoted_text() {
  skip_blanks();
  const char quote = text_.empty() ? '\0' : text_.front();
  if (quote != '\'' && quote != '"') refuse("expected a quoted text");
  const std::size_t end = text_.find(quote, 1);
  if (end == std::string_view::npos) refuse("a quoted text has no end");
  const std::string_view inside = text_.substr(1, end - 1);
  text_.remove_prefix(end + 1);
  return inside;
}

GONIO_INLINE bool npy_header_reader::boolean() {
  skip_blanks();
  for (const auto& [word, value] :
       {std::pair{std::string_view("True"), true}, std::pair{std::string_view("False"), false}}) {
    if (!text_.starts_with(word)) continue;
    text_.remove_prefix(word.size());
    return value;
  }
  refuse("fortran_order is neither True nor False");
}

GONIO_INLINE std::vector<std::size_t> npy_header_reader::tuple() {
  std::vector<std::size_t> extents;
  expect('(');
  while (!accept(')')) {
    extents.push_back(count());
    if (extents.size() > 32) refuse("the shape has more than 32 dimensions");
    if (accept(',')) continue;
    expect(')');
    break;
  }
  return extents;
}

GONIO_INLINE std::size_t npy_header_reader::count() {
  skip_blanks();
  std::size_t value = 0;
  const auto [end, failed] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
  if (failed != std::errc()) refuse("an extent of the shape is not a number of at least 0");
  text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
  return value;
}

GONIO_INLINE bool npy_header_reader::accept(char c) {
  skip_blanks();
  if (!text_.starts_with(c)) return false;
  text_.remove_prefix(1);
  return true;
}

GONIO_INLINE void npy_header_reader::refuse(const std::string& what) const {
  gonio::refuse({name_, ": npy header: ", what});
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE npy_layout read_npy_header(std::span<const std::byte>& bytes, const std::string& name) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with(detail::npy_magic))
    gonio::refuse({name, ": is not an npy file, expected it to start with \\x93NUMPY"});
  const std::size_t version_at = detail::npy_magic.size();
  const auto byte_at = [&](std::size_t i) { return std::to_integer<std::size_t>(bytes[i]); };
  if (bytes.size() < version_at + 2) gonio::refuse({name, ": npy header: truncated"});
  const std::size_t version = byte_at(version_at);
  if (version < 1 || version > 3 || byte_at(version_at + 1) != 0)
    gonio::refuse({name, ": npy version ", version, ".", byte_at(version_at + 1), ", expected 1.0, 2.0 or 3.0"});

  // The length of the header takes two bytes in version 1, four in later ones.
  const std::size_t begin = version_at + 2 + (version == 1 ? 2 : 4);
  if (bytes.size() < begin) gonio::refuse({name, ": npy header: truncated"});
  std::size_t length = 0;
  for (std::size_t i = begin; i > version_at + 2; --i) length = length * 256 + byte_at(i - 1);
  if (bytes.size() - begin < length) gonio::refuse({name, ": npy header: truncated"});
  npy_layout layout = detail::npy_header_reader(text.substr(begin, length), name).read();
  bytes = bytes.subspan(begin + length);
  return layout;
}

GONIO_INLINE std::string npy_header(std::string_view type, const std::string& shape) {
  std::string dictionary = message_of({"{'descr': '", type, "', 'fortran_order': False, 'shape': ", shape, ", }"});
  const std::size_t before = detail::npy_magic.size() + 4;
  dictionary.resize((before + dictionary.size() + 1 + 63) / 64 * 64 - before - 1, ' ');
  dictionary += '\n';
  std::string header(detail::npy_magic);
  for (const std::size_t byte : {std::size_t{1}, std::size_t{0}, dictionary.size() % 256, dictionary.size() / 256})
    header += static_cast<char>(byte);
  return header + dictionary;
}

}  // namespace gonio::io
