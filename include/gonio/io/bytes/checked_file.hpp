#pragma once
/// What the binary files of this library have in common: a magic word, a version, and a payload that is deflated and
/// checksummed. Described in docs/reference/formats.md.

#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/bytes/gzip.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

/// A kind of file.
struct checked_file_kind {
  std::string_view magic;
  std::uint32_t version;     ///< of what is written
  std::string_view noun;     ///< what errors call it
  std::uint32_t oldest = 0;  ///< the first version that is read, too; 0: `version` alone is
};

/// The CRC-32 of bytes, as of gzip.
[[nodiscard]] std::uint32_t checksum(std::span<const std::byte> bytes);
[[nodiscard]] inline std::uint32_t checksum(std::string_view text) { return checksum(std::as_bytes(std::span(text))); }

namespace detail {

/// More than any plausible payload, so that a corrupt size is refused before memory is asked for.
inline constexpr std::uint64_t payload_size_limit = std::uint64_t{4} << 30;

/// Reads the magic word and the version. Throws gonio::error starting with `name` if they are others.
void read_kind(const checked_file_kind& kind, byte_reader& file, const std::string& name);

}  // namespace detail

/// A payload as the bytes of a file.
[[nodiscard]] std::vector<std::byte> write_checked(const checked_file_kind& kind, std::span<const std::byte> payload);

/// The payload in the bytes of a file. Throws gonio::error starting with `name` where they are not of the kind, of
/// another version, damaged (checksum), truncated or over-long.
[[nodiscard]] std::vector<std::byte> read_checked(const checked_file_kind& kind, std::span<const std::byte> bytes,
                                                  const std::string& name);

/// Does the file start as this kind does?
[[nodiscard]] bool is_of_kind(const checked_file_kind& kind, const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/bytes/impl/checked_file.ipp>
#endif
