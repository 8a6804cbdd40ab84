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

  [[nodiscard]] npy_layout parse();

 private:
  void parse_entry();

  [[nodiscard]] npy_layout layout() const;

  [[nodiscard]] std::string_view quoted_text();

  [[nodiscard]] bool boolean();

  [[nodiscard]] std::vector<std::size_t> tuple();

  [[nodiscard]] std::size_t count();

  void skip_blanks() { text_.remove_prefix(std::min(text_.find_first_not_of(" \n"), text_.size())); }
  [[nodiscard]] bool accept(char c);
  void expect(char c) {
    if (!accept(c)) refuse(std::string("expected '") + c + "'");
  }
  [[noreturn]] void refuse(const std::string& what) const;

  std::string_view text_;
  const std::string& name_;
  std::optional<std::string_view> descr_;
  std::optional<bool> order_;
  std::optional<std::vector<std::size_t>> shape_;
};

/// Takes the magic, version and header off the front of a file's bytes.
[[nodiscard]] npy_layout take_npy_header(std::span<const std::byte>& bytes, const std::string& name);

template <std::floating_point Stored, std::floating_point T>
void copy_elements(std::span<const std::byte> bytes, std::span<T> out, const std::string& name) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    Stored value{};
    std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
    if constexpr (sizeof(T) < sizeof(Stored)) {
      if (std::isfinite(value) && std::abs(value) > Stored{std::numeric_limits<T>::max()})
        gonio::refuse({name, ": element ", i, " is ", value, ", too large for float32"});
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
    gonio::refuse({name, ": has shape ", detail::npy_shape_text(layout.shape), ", expected ", Rank,
                   (Rank == 1 ? " dimension" : " dimensions")});
  if (bytes.size() != layout.count * layout.word_size)
    gonio::refuse({name, ": has ", bytes.size(), " bytes of elements, expected ", layout.count * layout.word_size,
                   " for its shape"});
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

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/npy.ipp>
#endif
