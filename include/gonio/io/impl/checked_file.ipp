#pragma once
/// Bodies of io/checked_file.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/byte_stream.hpp>
#include <gonio/io/checked_file.hpp>
#include <gonio/io/file.hpp>
#include <gonio/io/gzip.hpp>

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE std::uint32_t checksum(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));  // NOLINT: zlib's byte type
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE std::vector<std::byte> encode_checked(const checked_file_kind& kind, std::span<const std::byte> payload) {
  byte_writer file;
  file.put_bytes(kind.magic.data(), kind.magic.size());
  file.put(kind.version);
  file.put(std::uint64_t{payload.size()});
  file.put(detail::checksum(payload));
  const std::vector<std::byte> deflated = compress_bytes(payload);
  file.put_bytes(deflated.data(), deflated.size());
  return file.take();
}

GONIO_INLINE std::vector<std::byte> decode_checked(const checked_file_kind& kind, std::span<const std::byte> bytes,
                                                   const std::string& name) {
  byte_reader file(bytes, name);
  const auto magic = file.take_bytes(std::min(kind.magic.size(), file.left()));
  if (magic.size() != kind.magic.size() || std::memcmp(magic.data(), kind.magic.data(), magic.size()) != 0)
    throw error{name, ": not a gonio ", kind.noun, " (it does not start with '", kind.magic, "')"};
  const auto version = file.take<std::uint32_t>();
  if (version != kind.version)
    throw error{name, ": ", kind.noun, " format version ", version, ", this program reads version ", kind.version};
  const auto size = file.take<std::uint64_t>();
  if (size > detail::payload_size_limit) throw error{name, ": a ", kind.noun, " of ", size, " bytes is not believable"};
  const auto expected = file.take<std::uint32_t>();
  std::vector<std::byte> payload = decompress_bytes(file.take_bytes(file.left()), static_cast<std::size_t>(size), name);
  if (detail::checksum(payload) != expected) throw error{name, ": the checksum does not match, the file is damaged"};
  return payload;
}

GONIO_INLINE bool is_of_kind(const checked_file_kind& kind, const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string start(kind.magic.size(), '\0');
  return file.read(start.data(), static_cast<std::streamsize>(start.size())) && start == kind.magic;
}

}  // namespace gonio::io
