#pragma once
/// Little-endian binary records in memory: a writer that appends and a reader that never reads past the end.

#include <gonio/core/error.hpp>

#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio::io {

static_assert(std::endian::native == std::endian::little,
              "the binary formats are little-endian, as is every supported machine");

/// Appends numbers and arrays to a byte buffer.
class byte_writer {
 public:
  template <class Number>
  requires std::is_trivially_copyable_v<Number>
  void write(Number value) { write_bytes(&value, sizeof value); }

  template <class Number>
  requires std::is_trivially_copyable_v<Number>
  void write_all(std::span<const Number> values) { write_bytes(values.data(), values.size_bytes()); }

  void write_bytes(const void* bytes, std::size_t count);

  /// Appends a text: its length (32 bits) and its characters.
  void write_text(const std::string& text);

  [[nodiscard]] std::span<const std::byte> bytes() const& noexcept { return bytes_; }
  [[nodiscard]] std::vector<std::byte> bytes() && noexcept { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

/// Reads numbers and arrays from the front of a byte buffer. Throws gonio::error naming `name` if too few bytes are
/// left. Checks counts against the bytes left before it allocates.
class byte_reader {
 public:
  byte_reader(std::span<const std::byte> bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  template <class Number>
  requires std::is_trivially_copyable_v<Number>
  [[nodiscard]] Number read() {
    Number value;
    std::memcpy(&value, read_bytes(sizeof(Number)).data(), sizeof(Number));
    return value;
  }

  template <class Number>
  requires std::is_trivially_copyable_v<Number>
  [[nodiscard]] std::vector<Number> read_all(std::size_t count) {
    if (count > bytes_.size() / sizeof(Number)) fail();
    std::vector<Number> values(count);
    const auto bytes = read_bytes(count * sizeof(Number));
    if (count != 0) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

  [[nodiscard]] std::string read_text();

  [[nodiscard]] std::span<const std::byte> read_bytes(std::size_t count);

  [[nodiscard]] std::size_t left() const noexcept { return bytes_.size(); }

 private:
  [[noreturn]] void fail() const;

  std::span<const std::byte> bytes_;
  std::string name_;
};

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/bytes/impl/byte_stream.ipp>
#endif
