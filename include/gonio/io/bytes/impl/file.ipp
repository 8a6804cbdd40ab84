#pragma once
/// Bodies of io/bytes/file.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#if defined(_WIN32)
#include <gonio/io/bytes/impl/file_windows.ipp>
#else
#include <gonio/io/bytes/impl/file_posix.ipp>
#endif

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE std::string system_reason(int code) { return std::generic_category().message(code); }

[[gnu::cold]] GONIO_INLINE void refuse_file(const std::filesystem::path& path,
                                            std::initializer_list<message_part> what) {
  gonio::refuse({path.string(), ": ", message_of(what)});
}

[[gnu::cold]] GONIO_INLINE bool write_all(const descriptor& file, std::span<const std::byte> bytes) noexcept {
  while (!bytes.empty()) {
    // Windows counts in 32 bits.
    const auto count = ::write(file.get(), bytes.data(), std::min(bytes.size(), std::size_t{1} << 30));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

[[gnu::cold]] GONIO_INLINE std::vector<std::byte> read_bytes(const std::filesystem::path& path) {
  const descriptor file = open_to_read(path);
  const std::uint64_t size = size_of_regular(file, path);
  std::vector<std::byte> bytes;
  try {
    bytes.resize(static_cast<std::size_t>(size));
  } catch (const std::bad_alloc&) {
    refuse_file(path, "is too large for this machine's memory");
  } catch (const std::length_error&) {
    refuse_file(path, "is too large for this machine's memory");
  }
  if (read_at(file, 0, bytes, path) != bytes.size()) refuse_file(path, "became shorter while it was read");
  return bytes;
}

[[gnu::cold]] GONIO_INLINE void file_writer::write(std::span<const std::byte> bytes) {
  if (!write_all(file_, bytes)) fail();
}

[[gnu::cold]] GONIO_INLINE void file_writer::fail() const {
  refuse_file(path_, {"cannot be written: ", system_reason(errno)});
}

[[gnu::cold]] GONIO_INLINE void write_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  file_writer file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace gonio::io
