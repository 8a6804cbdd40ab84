#pragma once
/// Files that claim more than they hold, too large or too easily made to be kept.

#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/bytes/gzip.hpp>

#include <doctest/doctest.h>
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace crafted {

using byte_vector = std::vector<std::byte>;

[[nodiscard]] inline byte_vector bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

inline void append(byte_vector& file, std::span<const std::byte> more) {
  file.insert(file.end(), more.begin(), more.end());
}

/// A deflated stream of these bytes and so many zeros, made without holding the zeros.
[[nodiscard]] inline byte_vector deflated(std::span<const std::byte> begin, std::uint64_t zeros, int window_bits) {
  z_stream stream{};
  REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  byte_vector result, room(1 << 16);
  const std::vector<unsigned char> none(1 << 20);
  const auto put = [&](const void* bytes, std::size_t size, int flush) {
    stream.next_in = static_cast<Bytef*>(const_cast<void*>(bytes));
    stream.avail_in = static_cast<uInt>(size);
    do {
      stream.next_out = reinterpret_cast<Bytef*>(room.data());
      stream.avail_out = static_cast<uInt>(room.size());
      REQUIRE(deflate(&stream, flush) != Z_STREAM_ERROR);
      append(result, std::span(room).first(room.size() - stream.avail_out));
    } while (stream.avail_out == 0);
  };
  put(begin.data(), begin.size(), Z_NO_FLUSH);
  for (; zeros > none.size(); zeros -= none.size()) put(none.data(), none.size(), Z_NO_FLUSH);
  put(none.data(), zeros, Z_FINISH);
  deflateEnd(&stream);
  return result;
}

[[nodiscard]] inline byte_vector gzipped(std::span<const std::byte> begin, std::uint64_t zeros) {
  return deflated(begin, zeros, MAX_WBITS + 16);
}

[[nodiscard]] inline byte_vector merl_header(std::initializer_list<std::int32_t> extents) {
  gonio::io::byte_writer header;
  for (const std::int32_t extent : extents) header.write(extent);
  return std::move(header).bytes();
}

/// A checked file whose payload is these bytes and so many zeros.
[[nodiscard]] inline byte_vector checked_file(const std::string& magic, std::span<const std::byte> begin,
                                              std::uint64_t zeros) {
  auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(begin.data()), begin.size());
  const std::vector<unsigned char> none(1 << 20);
  for (std::uint64_t left = zeros; left > 0; left -= std::min<std::uint64_t>(left, none.size()))
    sum = crc32_z(sum, none.data(), static_cast<z_size_t>(std::min<std::uint64_t>(left, none.size())));
  gonio::io::byte_writer file;
  file.write_bytes(magic.data(), magic.size());
  file.write(std::uint32_t{1});
  file.write(std::uint64_t{begin.size() + zeros});
  file.write(static_cast<std::uint32_t>(sum));
  const byte_vector payload = deflated(begin, zeros, MAX_WBITS);
  file.write_bytes(payload.data(), payload.size());
  return std::move(file).bytes();
}

struct prior_claims {
  std::uint32_t theta_h = 1, theta_d = 1, phi_d = 1;
  double minimum_cosine = 0.0;
  std::uint32_t components = 1, materials = 1;
};

[[nodiscard]] inline byte_vector prior_payload(const prior_claims& claims) {
  gonio::io::byte_writer out;
  for (const std::uint32_t number : {claims.theta_h, claims.theta_d, claims.phi_d, 0u}) out.write(number);
  out.write(claims.minimum_cosine);
  out.write(claims.components);
  out.write(claims.materials);
  return std::move(out).bytes();
}

[[nodiscard]] inline byte_vector prior_of(const prior_claims& claims, std::uint64_t zeros) {
  return checked_file("gonio-pca", prior_payload(claims), zeros);
}

[[nodiscard]] inline byte_vector shapes_of(std::initializer_list<std::uint32_t> vertices_triangles_components_shapes,
                                           std::uint64_t zeros) {
  gonio::io::byte_writer out;
  for (const std::uint32_t number : vertices_triangles_components_shapes) out.write(number);
  return checked_file("gonio-shapes", out.bytes(), zeros);
}

[[nodiscard]] inline std::string big_endian(std::size_t value) {
  return {static_cast<char>(value >> 24 & 255), static_cast<char>(value >> 16 & 255),
          static_cast<char>(value >> 8 & 255), static_cast<char>(value & 255)};
}

inline void append_chunk(byte_vector& file, const std::string& type, std::span<const std::byte> data) {
  byte_vector checked = bytes_of(type);
  append(checked, data);
  append(file, bytes_of(big_endian(data.size())));
  append(file, checked);
  append(file, bytes_of(big_endian(crc32_z(0, reinterpret_cast<const Bytef*>(checked.data()), checked.size()))));
}

/// A black PNG; `row` is the bytes of a row, its filter included.
[[nodiscard]] inline byte_vector black_png(std::size_t side, char depth, char type, std::size_t row) {
  byte_vector file = bytes_of("\x89PNG\r\n\x1a\n");
  append_chunk(file, "IHDR", bytes_of(big_endian(side) + big_endian(side) + depth + type + std::string(3, '\0')));
  append_chunk(file, "IDAT", deflated({}, row * side, MAX_WBITS));
  append_chunk(file, "IEND", {});
  return file;
}

/// A Radiance HDR whose rows are runs of one value.
[[nodiscard]] inline byte_vector flat_hdr(std::size_t side) {
  std::string text =
      "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(side) + " +X " + std::to_string(side) + "\n";
  std::string row = {2, 2, static_cast<char>(side >> 8), static_cast<char>(side & 255)};
  for (int channel = 0; channel < 4; ++channel)
    for (std::size_t left = side; left > 0;) {
      const std::size_t run = std::min<std::size_t>(left, 127);
      row += {static_cast<char>(128 + run), '\x40'};
      left -= run;
    }
  for (std::size_t i = 0; i < side; ++i) text += row;
  return bytes_of(text);
}

[[nodiscard]] inline std::string repeated(const std::string& text, std::size_t times) {
  std::string result;
  for (std::size_t i = 0; i < times; ++i) result += text;
  return result;
}

}  // namespace crafted
