#pragma once
/// Bodies of io/bytes/checked_file.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/bytes/believable.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/bytes/gzip.hpp>

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE std::uint32_t checksum(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));  // NOLINT: zlib's byte type
}

}  // namespace gonio::io

namespace gonio::io::detail {

[[gnu::cold]] GONIO_INLINE void read_kind(const checked_file_kind& kind, byte_reader& file, const std::string& name) {
  const auto magic = file.read_bytes(std::min(kind.magic.size(), file.left()));
  if (magic.size() != kind.magic.size() || std::memcmp(magic.data(), kind.magic.data(), magic.size()) != 0)
    gonio::refuse({name, ": not a gonio ", kind.noun, " (it does not start with '", kind.magic, "')"});
  const auto version = file.read<std::uint32_t>();
  const std::uint32_t oldest = kind.oldest == 0 ? kind.version : kind.oldest;
  if (version >= oldest && version <= kind.version) return;
  const std::string readable = oldest == kind.version ? message_of({"version ", oldest})
                                                      : message_of({"versions ", oldest, " to ", kind.version});
  gonio::refuse({name, ": ", kind.noun, " format version ", version, ", this program reads ", readable});
}

/// Returns a zlib stream of at least an eighth of the payload's size. Used if deflate would shrink the payload so much
/// that `is_believable` refused the file.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::vector<std::byte> huffman_code(std::span<const std::byte> bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS, 8, Z_HUFFMAN_ONLY) != Z_OK)
    throw std::bad_alloc();
  const auto at_once = [](std::size_t size) { return static_cast<uInt>(std::min<std::size_t>(size, 1u << 30)); };
  std::vector<std::byte> result(deflateBound(&stream, static_cast<uLong>(bytes.size())));
  int status = Z_OK;
  while (status == Z_OK) {
    // zlib's interface predates const, and counts in 32 bits.
    const std::size_t taken = stream.total_in;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data() + taken));
    stream.avail_in = at_once(bytes.size() - taken);
    stream.next_out = reinterpret_cast<Bytef*>(result.data() + stream.total_out);
    stream.avail_out = at_once(result.size() - stream.total_out);
    status = deflate(&stream, taken + stream.avail_in == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
  }
  result.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw std::bad_alloc();
  return result;
}

}  // namespace gonio::io::detail

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE std::vector<std::byte> write_checked(const checked_file_kind& kind,
                                                                std::span<const std::byte> payload) {
  byte_writer file;
  file.write_bytes(kind.magic.data(), kind.magic.size());
  file.write(kind.version);
  file.write(std::uint64_t{payload.size()});
  file.write(checksum(payload));
  std::vector<std::byte> deflated = compress_bytes(payload);
  if (!detail::is_believable(payload.size(), detail::freely_claimed_payload, deflated.size()))
    deflated = detail::huffman_code(payload);
  file.write_bytes(deflated.data(), deflated.size());
  return std::move(file).bytes();
}

[[gnu::cold]] GONIO_INLINE std::vector<std::byte> read_checked(const checked_file_kind& kind,
                                                               std::span<const std::byte> bytes,
                                                               const std::string& name) {
  byte_reader file(bytes, name);
  detail::read_kind(kind, file, name);
  const auto size = file.read<std::uint64_t>();
  const auto expected = file.read<std::uint32_t>();
  if (size > detail::payload_size_limit || !detail::is_believable(size, detail::freely_claimed_payload, file.left()))
    gonio::refuse({name, ": a ", kind.noun, " of ", size, " bytes cannot fit in ", file.left(), " compressed bytes"});
  std::vector<std::byte> payload = decompress_bytes(file.read_bytes(file.left()), static_cast<std::size_t>(size), name);
  if (checksum(payload) != expected) gonio::refuse({name, ": the checksum does not match, the file is damaged"});
  return payload;
}

[[gnu::cold]] GONIO_INLINE bool is_of_kind(const checked_file_kind& kind, const std::filesystem::path& path) {
  // Opening a pipe would wait for its writer.
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string start(kind.magic.size(), '\0');
  return file.read(start.data(), static_cast<std::streamsize>(start.size())) && start == kind.magic;
}

}  // namespace gonio::io
