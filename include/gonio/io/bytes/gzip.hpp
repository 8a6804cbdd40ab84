#pragma once
/// Deflated data by zlib: gzip files (RFC 1952; several members are joined, as gzip does) and zlib streams (RFC 1950)
/// of a known size. Throws gonio::error if the data is truncated, corrupt or too long, or if anything follows it.
/// Memory grows with the actual data, not with the size that a file claims.

#include <gonio/core/error.hpp>

#include <zlib.h>

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

namespace detail {

/// The largest factor by which deflate can shrink data.
inline constexpr std::size_t deflate_limit = 1032;

enum class deflate_format : int { zlib = MAX_WBITS, gzip = MAX_WBITS + 16 };

/// Expands one deflated stream after another out of a buffer.
class inflater {
 public:
  inflater(std::span<const std::byte> bytes, deflate_format format, std::string name);
  inflater(const inflater&) = delete;
  inflater& operator=(const inflater&) = delete;
  ~inflater() { inflateEnd(&stream_); }

  /// Fills `out` unless the stream ends first; returns the number of bytes written.
  [[nodiscard]] std::size_t read(std::span<std::byte> out);

  /// Has the stream ended, including its checksum?
  [[nodiscard]] bool ended() const noexcept { return ended_; }
  [[nodiscard]] std::span<const std::byte> left() const noexcept { return left_; }

  /// Prepares to read the stream that follows the ended one.
  void restart();

  /// Throws gonio::error with the joined parts of the message.
  [[noreturn]] void refuse(std::initializer_list<message_part> what) const;

 private:
  [[noreturn]] void fail(int status) const;

  z_stream stream_{};
  std::span<const std::byte> left_;
  std::string name_;
  bool ended_ = false;
};

/// Expands the current stream into `result` from byte `size` on, until the stream ends or `result` holds `limit` bytes.
/// Returns the number of bytes filled, at most the size of `result`, which grows with the actual data.
[[nodiscard]] std::size_t expand(inflater& stream, std::vector<std::byte>& result, std::size_t size, std::size_t limit);

/// Returns the initial buffer for expanded data: of `claimed` bytes, but at most 64 per compressed byte.
[[nodiscard]] std::vector<std::byte> first_buffer(std::size_t claimed, std::size_t compressed);

}  // namespace detail

/// Do the bytes start as a gzip file does?
[[nodiscard]] inline bool is_gzip(std::span<const std::byte> bytes) noexcept {
  return bytes.size() >= 2 && bytes[0] == std::byte{0x1f} && bytes[1] == std::byte{0x8b};
}

/// Expands a gzip file of any number of members. Throws gonio::error if it expands to more than `maximum_size` bytes.
[[nodiscard]] std::vector<std::byte> gunzip(std::span<const std::byte> bytes, std::size_t maximum_size,
                                            const std::string& name);

/// Expands the first member of a gzip file; returns its first `count` bytes, or all if it has fewer.
[[nodiscard]] std::vector<std::byte> gunzip_prefix(std::span<const std::byte> bytes, std::size_t count,
                                                   const std::string& name);

/// Deflates to a zlib stream; level 1 is fast, 9 is small.
[[nodiscard]] std::vector<std::byte> compress_bytes(std::span<const std::byte> bytes, int level = 9);

/// Expands a zlib stream. Throws gonio::error unless it holds exactly `expected_size` bytes and nothing follows.
[[nodiscard]] std::vector<std::byte> decompress_bytes(std::span<const std::byte> bytes, std::size_t expected_size,
                                                      const std::string& name);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/bytes/impl/gzip.ipp>
#endif
