#pragma once
/// Arrays in numpy's .npy format, in C order: reads float16, float32 and float64. The caller gives the number of
/// dimensions: `read_npy<float, 2>("networks.npy")` is an xt::xtensor<float, 2>.
/// https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
///
/// xtensor's own reader (xnpy.hpp) trusts the file: it checks neither that reads succeed nor that the shape's product
/// fits in memory, and it needs the header's keys in one order.

#include <gonio/core/arrays.hpp>
#include <gonio/core/half.hpp>
#include <gonio/io/bytes/file.hpp>

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
              "arrays are written as little-endian, which every supported machine is");

/// The checked content of a file's header.
struct npy_layout {
  std::size_t word_size = 0;
  std::vector<std::size_t> shape;
  std::size_t count = 1;
};

/// Returns a shape as Python writes a tuple.
template <class Shape>
[[nodiscard]] std::string npy_shape_text(const Shape& shape) {
  std::string text;
  for (const std::size_t extent : shape) text += (text.empty() ? "" : ", ") + std::to_string(extent);
  return "(" + text + (std::size(shape) == 1 ? ",)" : ")");
}

namespace detail {

inline constexpr std::string_view npy_magic = "\x93NUMPY";

/// Reads the header's dictionary: a Python literal with exactly the keys descr, fortran_order and shape.
class npy_header_reader {
 public:
  npy_header_reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  [[nodiscard]] npy_layout read();

 private:
  void read_entry();

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

}  // namespace detail

/// Reads magic, version and header, and removes them from the front of a file's bytes.
[[nodiscard]] npy_layout read_npy_header(std::span<const std::byte>& bytes, const std::string& name);

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

/// Converts half floats.
template <std::floating_point T>
void copy_halves(std::span<const std::byte> bytes, std::span<T> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::uint16_t bits = 0;
    std::memcpy(&bits, bytes.data() + i * sizeof bits, sizeof bits);
    out[i] = from_half(bits);
  }
}

/// Returns the header of a version 1.0 file as numpy writes it: the elements begin at a multiple of 64 bytes.
[[nodiscard]] std::string npy_header(std::string_view type, const std::string& shape);

template <class T>
concept npy_element = std::same_as<T, float> || std::same_as<T, double>;

/// Reads an array from the bytes of an .npy file and converts its elements to T. Errors call the file `name`. NaN and
/// infinity are kept; the caller checks for them.
template <npy_element T, std::size_t Rank>
[[nodiscard]] xt::xtensor<T, Rank> read_npy(std::span<const std::byte> bytes, const std::string& name) {
  const npy_layout layout = read_npy_header(bytes, name);
  if (layout.shape.size() != Rank)
    gonio::refuse({name, ": has shape ", npy_shape_text(layout.shape), ", expected ", Rank,
                   (Rank == 1 ? " dimension" : " dimensions")});
  if (bytes.size() != layout.count * layout.word_size)
    gonio::refuse({name, ": has ", bytes.size(), " bytes of elements, expected ", layout.count * layout.word_size,
                   " for its shape"});
  std::array<std::size_t, Rank> shape{};
  std::ranges::copy(layout.shape, shape.begin());
  xt::xtensor<T, Rank> array(shape);
  const std::span<T> elements(array.data(), layout.count);
  if (layout.word_size == sizeof(std::uint16_t))
    copy_halves(bytes, elements);
  else if (layout.word_size == sizeof(float))
    copy_elements<float>(bytes, elements, name);
  else
    copy_elements<double>(bytes, elements, name);
  return array;
}

/// Reads an .npy file.
template <npy_element T, std::size_t Rank>
[[nodiscard]] xt::xtensor<T, Rank> read_npy(const std::filesystem::path& path) {
  return read_npy<T, Rank>(read_bytes(path), path.string());
}

/// Writes an array as numpy does (version 1.0).
template <npy_element T, std::size_t Rank>
void write_npy(const std::filesystem::path& path, const xt::xtensor<T, Rank>& array) {
  const std::string header = npy_header(sizeof(T) == 4 ? "<f4" : "<f8", npy_shape_text(array.shape()));
  write_atomically(path, [&](file_writer& file) {
    file.write(std::as_bytes(std::span(header)));
    file.write(std::as_bytes(std::span(array.data(), array.size())));
  });
}

/// Writes an array as half floats, which have 11 significant bits and half the size of float32. Throws gonio::error
/// naming the first number outside the range of half floats.
template <std::size_t Rank>
void write_npy_halves(const std::filesystem::path& path, const xt::xtensor<float, Rank>& array) {
  std::vector<std::uint16_t> halves(array.size());
  for (std::size_t i = 0; i < halves.size(); ++i) {
    const float value = array.data()[i];
    halves[i] = to_half(value);
    if (std::isfinite(value) && !std::isfinite(from_half(halves[i])))
      gonio::refuse({path.string(), ": element ", i, " is ", double{value},
                     ", outside the range of half floats, -65504 to 65504: write float32"});
  }
  const std::string header = npy_header("<f2", npy_shape_text(array.shape()));
  write_atomically(path, [&](file_writer& file) {
    file.write(std::as_bytes(std::span(header)));
    file.write(std::as_bytes(std::span(halves)));
  });
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/bytes/impl/npy.ipp>
#endif
