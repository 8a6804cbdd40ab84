#pragma once
/// Bodies of io/bytes/gzip.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/gzip.hpp>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::io::detail {

[[gnu::cold]] [[nodiscard]] GONIO_INLINE uInt at_most_a_gigabyte(std::size_t size) noexcept {
  return static_cast<uInt>(std::min<std::size_t>(size, 1u << 30));
}

[[gnu::cold]] GONIO_INLINE inflater::inflater(std::span<const std::byte> bytes, deflate_format format, std::string name)
    : left_(bytes), name_(std::move(name)) {
  if (inflateInit2(&stream_, static_cast<int>(format)) != Z_OK) throw std::bad_alloc();
}

[[gnu::cold]] GONIO_INLINE std::size_t inflater::read(std::span<std::byte> out) {
  std::size_t size = 0;
  while (size < out.size() && !ended_) {
    const uInt offered = at_most_a_gigabyte(left_.size());
    const uInt room = at_most_a_gigabyte(out.size() - size);
    // zlib's interface predates const; it does not write to its input.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(left_.data()));
    stream_.avail_in = offered;
    stream_.next_out = reinterpret_cast<Bytef*>(out.data() + size);
    stream_.avail_out = room;
    const int status = inflate(&stream_, Z_NO_FLUSH);
    left_ = left_.subspan(offered - stream_.avail_in);
    size += room - stream_.avail_out;
    if (status == Z_STREAM_END)
      ended_ = true;
    else if (status != Z_OK)
      fail(status);
  }
  return size;
}

[[gnu::cold]] GONIO_INLINE void inflater::restart() {
  inflateReset(&stream_);
  ended_ = false;
}

[[gnu::cold]] GONIO_INLINE void inflater::refuse(std::initializer_list<message_part> what) const {
  gonio::refuse({name_, ": ", message_of(what)});
}

[[gnu::cold]] GONIO_INLINE void inflater::fail(int status) const {
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status == Z_BUF_ERROR) refuse({"the compressed data is truncated"});
  refuse({"the compressed data is corrupt (", stream_.msg ? stream_.msg : zError(status), ")"});
}

[[gnu::cold]] GONIO_INLINE std::size_t expand(inflater& stream, std::vector<std::byte>& result, std::size_t size,
                                              std::size_t limit) {
  while (true) {
    size += stream.read(std::span(result).subspan(size));
    if (stream.ended() || result.size() == limit) return size;
    // Double the buffer; from a quarter of the limit on, go straight to the limit. Growing holds the old and the new
    // buffer at once, so the old one should be small in the last step.
    const std::size_t doubled = std::max<std::size_t>(2 * result.size(), 4096);
    const std::size_t next = doubled < limit / 2 ? doubled : limit;
    result.reserve(next);
    result.resize(next);
  }
}

[[gnu::cold]] GONIO_INLINE std::vector<std::byte> first_buffer(std::size_t claimed, std::size_t compressed) {
  constexpr std::size_t ordinary = 64;
  return std::vector<std::byte>(std::min(claimed, ordinary * compressed));
}

}  // namespace gonio::io::detail

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE std::vector<std::byte> gunzip(std::span<const std::byte> bytes, std::size_t maximum_size,
                                                         const std::string& name) {
  detail::inflater stream(bytes, detail::deflate_format::gzip, name);
  if (!is_gzip(bytes)) stream.refuse({"is not gzip data"});
  // Leave room for one byte more than allowed: it shows that the data is too long, and zlib needs it to read the
  // checksum of data that fits exactly.
  const std::size_t limit = std::min(maximum_size, std::numeric_limits<std::size_t>::max() - 1) + 1;
  // A file of one member ends with its expanded size modulo 2^32.
  std::uint32_t claimed = 0;
  if (bytes.size() >= sizeof claimed) std::memcpy(&claimed, bytes.last(sizeof claimed).data(), sizeof claimed);
  std::vector<std::byte> result = detail::first_buffer(std::min(std::size_t{claimed} + 1, limit), bytes.size());
  std::size_t size = 0;
  while (true) {
    size = detail::expand(stream, result, size, limit);
    if (size > maximum_size) stream.refuse({"expands to more than the expected ", maximum_size, " bytes"});
    if (stream.left().empty()) break;
    if (!is_gzip(stream.left())) stream.refuse({stream.left().size(), " bytes follow the compressed data"});
    stream.restart();
  }
  result.resize(size);
  return result;
}

[[gnu::cold]] GONIO_INLINE std::vector<std::byte> gunzip_prefix(std::span<const std::byte> bytes, std::size_t count,
                                                                const std::string& name) {
  detail::inflater stream(bytes, detail::deflate_format::gzip, name);
  if (!is_gzip(bytes)) stream.refuse({"is not gzip data"});
  std::vector<std::byte> result(count);
  result.resize(stream.read(result));
  return result;
}

[[gnu::cold]] GONIO_INLINE std::vector<std::byte> compress_bytes(std::span<const std::byte> bytes, int level) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::byte> result(size);
  const int status = compress2(reinterpret_cast<Bytef*>(result.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), level);
  if (status != Z_OK) throw std::bad_alloc();
  result.resize(size);
  return result;
}

[[gnu::cold]] GONIO_INLINE std::vector<std::byte> decompress_bytes(std::span<const std::byte> bytes,
                                                                   std::size_t expected_size, const std::string& name) {
  detail::inflater stream(bytes, detail::deflate_format::zlib, name);
  if (expected_size / detail::deflate_limit > bytes.size())
    stream.refuse({"the compressed data is truncated: its ", bytes.size(), " bytes cannot hold the expected ",
                   expected_size, " bytes"});
  std::vector<std::byte> result = detail::first_buffer(expected_size, bytes.size());
  const std::size_t size = detail::expand(stream, result, 0, expected_size);
  if (size < expected_size)
    stream.refuse({"expands to ", size, " bytes, not to the expected ", expected_size, " bytes"});
  // The stream ends with its checksum, which zlib reads only if there is room for one more byte.
  std::array<std::byte, 1> surplus{};
  if (stream.read(surplus) != 0) stream.refuse({"expands to more than the expected ", expected_size, " bytes"});
  if (!stream.left().empty()) stream.refuse({stream.left().size(), " bytes follow the compressed data"});
  return result;
}

}  // namespace gonio::io
