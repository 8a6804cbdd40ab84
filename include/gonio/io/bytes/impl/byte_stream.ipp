#pragma once
/// Bodies of io/bytes/byte_stream.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/byte_stream.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace gonio::io {

GONIO_INLINE void byte_writer::write_bytes(const void* bytes, std::size_t count) {
  const auto* begin = static_cast<const std::byte*>(bytes);
  bytes_.insert(bytes_.end(), begin, begin + count);
}

GONIO_INLINE void byte_writer::write_text(const std::string& text) {
  write(static_cast<std::uint32_t>(text.size()));
  write_bytes(text.data(), text.size());
}

GONIO_INLINE std::string byte_reader::read_text() {
  const auto characters = read_bytes(read<std::uint32_t>());
  return {reinterpret_cast<const char*>(characters.data()), characters.size()};
}

GONIO_INLINE std::span<const std::byte> byte_reader::read_bytes(std::size_t count) {
  if (count > bytes_.size()) fail();
  const auto taken = bytes_.first(count);
  bytes_ = bytes_.subspan(count);
  return taken;
}

GONIO_INLINE void byte_reader::fail() const {
  gonio::refuse({name_, ": the file is truncated or its counts are wrong"});
}

}  // namespace gonio::io
