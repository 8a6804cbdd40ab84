/// PNG files, as images and as codes. Checksums that are wrong are put right, which fuzzers cannot.

#include "harness.hpp"
#include <gonio/io/images/image.hpp>

#include <zlib.h>

#include <algorithm>
#include <vector>

namespace {

/// The chunks as far as they are whole, each with its checksum.
std::vector<std::byte> with_checksums(fuzz::input bytes) {
  std::vector<std::byte> file(bytes.begin(), bytes.end());
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::size_t length = gonio::io::detail::big_endian(std::span(file).subspan(at));
    if (length > file.size() - at - 12) break;
    const auto sum = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(file.data()) + at + 4, static_cast<z_size_t>(length + 4)));
    for (std::size_t i = 0; i < 4; ++i) file[at + 8 + length + i] = static_cast<std::byte>(sum >> (24 - 8 * i));
    at += 12 + length;
  }
  return file;
}

void read(fuzz::input bytes) {
  const fuzz::memory_file file(with_checksums(bytes));
  static_cast<void>(gonio::io::read_png(file.path()));
  static_cast<void>(gonio::io::read_png_codes(file.path()));
}

const fuzz::registered harness("png", &read);

}  // namespace
