#pragma once
/// Deflated data by zlib: gzip files (RFC 1952, several members are joined as gzip does) and zlib streams
/// (RFC 1950) of a known size. Truncated, corrupt or over-long data is a gonio::error, as is anything that
/// follows the end; no size that a file merely claims is allocated.

#include <gonio/core/error.hpp>

#include <zlib.h>

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace gonio::io {

namespace detail {

/// The most bytes to which deflate can expand one byte.
inline constexpr std::size_t deflate_limit = 1032;

enum class deflate_format : int { zlib = MAX_WBITS, gzip = MAX_WBITS + 16 };

/// Expands one deflated stream after another out of a buffer.
class inflater {
 public:
  inflater(std::span<const std::byte> bytes, deflate_format format, std::string name);
  inflater(const inflater&) = delete;
  inflater& operator=(const inflater&) = delete;
  ~inflater() { inflateEnd(&stream_); }

  /// Fills `out` unless the stream ends before; returns how many bytes there are.
  [[nodiscard]] std::size_t read(std::span<std::byte> out);

  /// Has the stream, checksum included, ended?
  [[nodiscard]] bool ended() const noexcept { return ended_; }
  [[nodiscard]] std::span<const std::byte> left() const noexcept { return left_; }

  /// Turns to the stream that follows.
  void restart();

  /// The parts of the message, one after the other.
  [[noreturn]] void refuse(std::initializer_list<message_part> what) const;

 private:
  [[noreturn]] void fail(int status) const;

  z_stream stream_{};
  std::span<const std::byte> left_;
  std::string name_;
  bool ended_ = false;
};

/// Expands the current stream into `result` from `size` on until it ends or `limit` bytes are full; returns
/// their number. The buffer grows with what really comes.
[[nodiscard]] std::size_t expand(inflater& stream, std::vector<std::byte>& result, std::size_t size, std::size_t limit);

/// A first size for the buffer: what is claimed, as long as the compression is an ordinary one.
[[nodiscard]] std::vector<std::byte> first_buffer(std::size_t claimed, std::size_t compressed);

}  // namespace detail

/// Does this start like a gzip file?
[[nodiscard]] inline bool is_gzip(std::span<const std::byte> bytes) noexcept {
  return bytes.size() >= 2 && bytes[0] == std::byte{0x1f} && bytes[1] == std::byte{0x8b};
}

/// Expands a gzip file of any number of members to at most `maximum_size` bytes.
[[nodiscard]] std::vector<std::byte> gunzip(std::span<const std::byte> bytes, std::size_t maximum_size,
                                            const std::string& name);

/// The first `count` bytes, or fewer if there are fewer, of what a gzip file's first member expands to.
[[nodiscard]] std::vector<std::byte> gunzip_prefix(std::span<const std::byte> bytes, std::size_t count,
                                                   const std::string& name);

/// Deflates to a zlib stream; level 1 is fast, 9 is small.
[[nodiscard]] std::vector<std::byte> compress_bytes(std::span<const std::byte> bytes, int level = 9);

/// Expands a zlib stream that must hold exactly `expected_size` bytes and nothing after it.
[[nodiscard]] std::vector<std::byte> decompress_bytes(std::span<const std::byte> bytes, std::size_t expected_size,
                                                      const std::string& name);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/bytes/impl/gzip.ipp>
#endif
