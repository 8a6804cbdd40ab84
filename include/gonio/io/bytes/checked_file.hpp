#pragma once
/// The common layout of this library's binary files: a magic word, a version, and a deflated payload with its checksum.
/// See docs/reference/formats.md.

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
  std::uint32_t version;     ///< the version that is written
  std::string_view noun;     ///< the kind's name in error messages
  std::uint32_t oldest = 0;  ///< the oldest version that is read; 0: only `version`
};

/// Returns the CRC-32 of bytes, as gzip computes it.
[[nodiscard]] std::uint32_t checksum(std::span<const std::byte> bytes);
[[nodiscard]] inline std::uint32_t checksum(std::string_view text) { return checksum(std::as_bytes(std::span(text))); }

namespace detail {

/// The largest plausible payload, in bytes. A file that claims more is refused before memory is allocated.
inline constexpr std::uint64_t payload_size_limit = std::uint64_t{4} << 30;

/// Reads the magic word and the version. Throws gonio::error starting with `name` if they are not `kind`'s.
void read_kind(const checked_file_kind& kind, byte_reader& file, const std::string& name);

}  // namespace detail

/// Returns the bytes of a file of this kind with this payload.
[[nodiscard]] std::vector<std::byte> write_checked(const checked_file_kind& kind, std::span<const std::byte> payload);

/// Returns the payload of a file. Throws gonio::error starting with `name` if the file is of another kind or version,
/// damaged (checksum), truncated or too long.
[[nodiscard]] std::vector<std::byte> read_checked(const checked_file_kind& kind, std::span<const std::byte> bytes,
                                                  const std::string& name);

/// Does the file start with this kind's magic word?
[[nodiscard]] bool is_of_kind(const checked_file_kind& kind, const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/bytes/impl/checked_file.ipp>
#endif
