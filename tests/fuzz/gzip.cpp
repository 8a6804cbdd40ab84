/// gzip files of any content, their beginnings, and zlib streams whose size is in their first two bytes.

#include "harness.hpp"
#include <gonio/io/bytes/gzip.hpp>

namespace {

void read(fuzz::input bytes) {
  if (gonio::io::is_gzip(bytes)) {
    static_cast<void>(gonio::io::gunzip_prefix(bytes, 12, fuzz::bytes_name));
    static_cast<void>(gonio::io::gunzip(bytes, std::size_t{1} << 24, fuzz::bytes_name));
  } else if (bytes.size() >= 2) {
    const std::size_t size = std::to_integer<std::size_t>(bytes[0]) + 256 * std::to_integer<std::size_t>(bytes[1]);
    static_cast<void>(gonio::io::decompress_bytes(bytes.subspan(2), size, fuzz::bytes_name));
  }
}

const fuzz::registered harness("gzip", &read);

}  // namespace
