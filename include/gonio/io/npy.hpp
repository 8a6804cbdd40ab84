#pragma once
/// Arrays of float32 or float64 in numpy's .npy format, in C order. The caller says the number of
/// dimensions: `read_npy<float, 2>("networks.npy")` is an xt::xtensor<float, 2>.
/// https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
///
/// xtensor's own reader (xnpy.hpp) believes what a file says of itself: it neither checks that reads
/// succeed nor that the shape's product fits in memory, and wants the header's keys in one order.

#include <gonio/io/file.hpp>

#include <xtensor/xtensor.hpp>

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

namespace gonio::io {

static_assert(std::endian::native == std::endian::little,
              "we write little-endian arrays, as is every supported machine");

namespace detail {

inline constexpr std::string_view npy_magic = "\x93NUMPY";

/// What the header of a file says, checked.
struct npy_layout {
  std::size_t word_size = 0;
  std::vector<std::size_t> shape;
  std::size_t count = 1;
};

/// A shape as Python writes a tuple.
template <class Shape>
[[nodiscard]] std::string npy_shape_text(const Shape& shape) {
  std::string text;
  for (const std::size_t extent : shape) text += (text.empty() ? "" : ", ") + std::to_string(extent);
  return "(" + text + (std::size(shape) == 1 ? ",)" : ")");
}

/// Reads the header's dictionary: a Python literal with exactly the keys descr, fortran_order and shape.
class npy_header_parser {
 public:
  npy_header_parser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  [[nodiscard]] npy_layout parse() {
    expect('{');
    while (!accept('}')) {
      parse_entry();
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

 private:
  void parse_entry() {
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

  [[nodiscard]] npy_layout layout() const {
    if (*descr_ != "<f4" && *descr_ != "<f8")
      refuse("holds elements of type '" + std::string(*descr_) + "', expected '<f4' or '<f8' (little-endian floats)");
    if (*order_) refuse("holds an array in Fortran order, expected C order (numpy.ascontiguousarray makes it so)");
    npy_layout found{*descr_ == "<f4" ? std::size_t{4} : std::size_t{8}, *shape_};
    constexpr std::size_t most = std::numeric_limits<std::ptrdiff_t>::max() / 8;
    // An extent of 0 must not hide that the others overflow.
    std::size_t product = 1;
    for (const std::size_t extent : found.shape) {
      const std::size_t factor = std::max<std::size_t>(extent, 1);
      if (product > most / factor) refuse("the product of the shape is too large");
      product *= factor;
      found.count *= extent;
    }
    return found;
  }

  [[nodiscard]] std::string_view quoted_text() {
    skip_blanks();
    const char quote = text_.empty() ? '\0' : text_.front();
    if (quote != '\'' && quote != '"') refuse("expected a quoted text");
    const std::size_t end = text_.find(quote, 1);
    if (end == std::string_view::npos) refuse("a quoted text has no end");
    const std::string_view inside = text_.substr(1, end - 1);
    text_.remove_prefix(end + 1);
    return inside;
  }

  [[nodiscard]] bool boolean() {
    skip_blanks();
    for (const auto& [word, value] :
         {std::pair{std::string_view("True"), true}, std::pair{std::string_view("False"), false}}) {
      if (!text_.starts_with(word)) continue;
      text_.remove_prefix(word.size());
      return value;
    }
    refuse("fortran_order is neither True nor False");
  }

  [[nodiscard]] std::vector<std::size_t> tuple() {
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

  [[nodiscard]] std::size_t count() {
    skip_blanks();
    std::size_t value = 0;
    const auto [end, failed] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (failed != std::errc()) refuse("an extent of the shape is not a number from 0 on");
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }

  void skip_blanks() { text_.remove_prefix(std::min(text_.find_first_not_of(" \n"), text_.size())); }
  [[nodiscard]] bool accept(char c) {
    skip_blanks();
    if (!text_.starts_with(c)) return false;
    text_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!accept(c)) refuse(std::string("expected '") + c + "'");
  }
  [[noreturn]] void refuse(const std::string& what) const { throw error(name_ + ": npy header: " + what); }

  std::string_view text_;
  const std::string& name_;
  std::optional<std::string_view> descr_;
  std::optional<bool> order_;
  std::optional<std::vector<std::size_t>> shape_;
};

/// Takes the magic, version and header off the front of a file's bytes.
[[nodiscard]] inline npy_layout take_npy_header(std::span<const std::byte>& bytes, const std::string& name) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with(npy_magic)) throw error(name + ": is no npy file, expected it to start with \\x93NUMPY");
  const std::size_t version_at = npy_magic.size();
  const auto byte_at = [&](std::size_t i) { return std::to_integer<std::size_t>(bytes[i]); };
  if (bytes.size() < version_at + 2) throw error(name + ": npy header: truncated");
  const std::size_t version = byte_at(version_at);
  if (version < 1 || version > 3 || byte_at(version_at + 1) != 0)
    throw error(name + ": npy version " + std::to_string(version) + "." + std::to_string(byte_at(version_at + 1)) +
                ", expected 1.0, 2.0 or 3.0");

  // The length of the header takes two bytes in version 1, four in later ones.
  const std::size_t begin = version_at + 2 + (version == 1 ? 2 : 4);
  if (bytes.size() < begin) throw error(name + ": npy header: truncated");
  std::size_t length = 0;
  for (std::size_t i = begin; i > version_at + 2; --i) length = length * 256 + byte_at(i - 1);
  if (bytes.size() - begin < length) throw error(name + ": npy header: truncated");
  npy_layout layout = npy_header_parser(text.substr(begin, length), name).parse();
  bytes = bytes.subspan(begin + length);
  return layout;
}

template <std::floating_point Stored, std::floating_point T>
void copy_elements(std::span<const std::byte> bytes, std::span<T> out, const std::string& name) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    Stored value{};
    std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
    if constexpr (sizeof(T) < sizeof(Stored)) {
      if (std::isfinite(value) && std::abs(value) > Stored{std::numeric_limits<T>::max()})
        throw error(name + ": element " + std::to_string(i) + " is " + std::to_string(value) +
                    ", too large for float32");
    }
    out[i] = static_cast<T>(value);
  }
}

}  // namespace detail

template <class T>
concept npy_element = std::same_as<T, float> || std::same_as<T, double>;

/// An array from the bytes of an .npy file, converted to T where it holds the other type; `name` is what
/// errors call it. NaN and infinity are left to whoever uses the array.
template <npy_element T, std::size_t Rank>
[[nodiscard]] xt::xtensor<T, Rank> parse_npy(std::span<const std::byte> bytes, const std::string& name) {
  const detail::npy_layout layout = detail::take_npy_header(bytes, name);
  if (layout.shape.size() != Rank)
    throw error(name + ": has shape " + detail::npy_shape_text(layout.shape) + ", expected " + std::to_string(Rank) +
                (Rank == 1 ? " dimension" : " dimensions"));
  if (bytes.size() != layout.count * layout.word_size)
    throw error(name + ": has " + std::to_string(bytes.size()) + " bytes of elements, expected " +
                std::to_string(layout.count * layout.word_size) + " for its shape");
  std::array<std::size_t, Rank> shape{};
  std::ranges::copy(layout.shape, shape.begin());
  xt::xtensor<T, Rank> array(shape);
  const std::span<T> elements(array.data(), layout.count);
  if (layout.word_size == sizeof(float))
    detail::copy_elements<float>(bytes, elements, name);
  else
    detail::copy_elements<double>(bytes, elements, name);
  return array;
}

/// Reads an .npy file.
template <npy_element T, std::size_t Rank>
[[nodiscard]] xt::xtensor<T, Rank> read_npy(const std::filesystem::path& path) {
  return parse_npy<T, Rank>(read_bytes(path), path.string());
}

/// Writes an array as numpy itself would (version 1.0).
template <npy_element T, std::size_t Rank>
void write_npy(const std::filesystem::path& path, const xt::xtensor<T, Rank>& array) {
  std::string dictionary = std::string("{'descr': '<f") + (sizeof(T) == 4 ? "4" : "8") +
                           "', 'fortran_order': False, 'shape': " + detail::npy_shape_text(array.shape()) + ", }";
  // The elements begin at a multiple of 64 bytes, after a line feed.
  const std::size_t before = detail::npy_magic.size() + 4;
  dictionary.resize((before + dictionary.size() + 1 + 63) / 64 * 64 - before - 1, ' ');
  dictionary += '\n';
  const std::string header = std::string(detail::npy_magic) + '\x01' + '\x00' +
                             static_cast<char>(dictionary.size() % 256) + static_cast<char>(dictionary.size() / 256) +
                             dictionary;
  write_atomically(path, [&](file_writer& file) {
    file.write(std::as_bytes(std::span(header)));
    file.write(std::as_bytes(std::span(array.data(), array.size())));
  });
}

}  // namespace gonio::io
