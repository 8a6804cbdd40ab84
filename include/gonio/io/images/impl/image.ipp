#pragma once
/// Bodies of io/images/image.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/io/bytes/believable.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/bytes/gzip.hpp>
#include <gonio/io/images/hdr_rows.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/render/image.hpp>
#include <gonio/table/stored_codes.hpp>

#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE int stb_size(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    gonio::refuse({name, ": has ", bytes.size(), " bytes, expected less than 2 GiB"});
  return static_cast<int>(bytes.size());
}

GONIO_INLINE void refuse_by_stb(const std::string& name) {
  const char* reason = stbi_failure_reason();
  gonio::refuse({name, ": cannot be decoded (", (reason ? reason : "no reason given"), ")"});
}

GONIO_INLINE std::size_t png_header::raw_size() const noexcept {
  const auto size_of = [&](std::size_t across, std::size_t down) {
    return across == 0 ? 0 : down * (1 + (across * channels * depth + 7) / 8);
  };
  if (!interlaced) return size_of(columns, rows);
  struct pass {
    std::size_t x, y, dx, dy;
  };
  constexpr std::array<pass, 7> adam7{
      {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}};
  std::size_t sum = 0;
  for (const auto& [x, y, dx, dy] : adam7)
    sum += size_of(columns > x ? (columns - x + dx - 1) / dx : 0, rows > y ? (rows - y + dy - 1) / dy : 0);
  return sum;
}

GONIO_INLINE std::uint32_t big_endian(std::span<const std::byte> bytes) noexcept {
  std::uint32_t value = 0;
  for (const std::byte b : bytes.first(4)) value = value << 8 | std::to_integer<std::uint32_t>(b);
  return value;
}

GONIO_INLINE png_header read_png_header(std::span<const std::byte> data, const std::string& name) {
  if (data.size() != 13) gonio::refuse({name, ": the PNG header has ", data.size(), " bytes, expected 13"});
  // Channels of the colour types 0 (grey), 2 (RGB), 3 (palette), 4 (grey and alpha), 6 (RGB and alpha).
  constexpr std::array<std::size_t, 7> channels{1, 0, 3, 1, 2, 0, 4};
  const auto byte_at = [&](std::size_t i) { return std::to_integer<std::size_t>(data[i]); };
  const std::size_t type = byte_at(9);
  const png_header header{big_endian(data), big_endian(data.subspan(4)), byte_at(8),
                          type < channels.size() ? channels[type] : 0, byte_at(12) == 1};
  check_image_size(header.rows, header.columns, name);
  constexpr std::array<std::size_t, 5> depths{1, 2, 4, 8, 16};
  if (header.channels == 0 || std::ranges::find(depths, header.depth) == depths.end())
    gonio::refuse({name, ": PNG colour type ", type, " with ", header.depth, " bits is unknown"});
  return header;
}

/// Throws gonio::error unless the pixels expand to exactly `expected` bytes, which are not kept.
GONIO_INLINE void check_png_pixels(std::span<const std::byte> deflated, std::size_t expected, const std::string& name) {
  inflater stream(deflated, deflate_format::zlib, name);
  std::vector<std::byte> some(std::min<std::size_t>(expected + 1, 1u << 16));
  std::size_t size = 0;
  while (!stream.ended() && size <= expected) size += stream.read(some);
  if (size > expected) stream.refuse({"expands to more than the expected ", expected, " bytes"});
  if (size < expected) stream.refuse({"expands to ", size, " bytes, not to the expected ", expected, " bytes"});
  if (!stream.left().empty()) stream.refuse({stream.left().size(), " bytes follow the compressed data"});
}

GONIO_INLINE void check_png(std::span<const std::byte> bytes, const std::string& name) {
  constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
  if (!std::ranges::equal(bytes.first(std::min(signature.size(), bytes.size())), std::as_bytes(std::span(signature))))
    gonio::refuse({name, ": is not a PNG file"});
  png_header header;
  std::vector<std::byte> pixels;
  std::string_view type;
  for (std::span<const std::byte> left = bytes.subspan(signature.size()); type != "IEND";) {
    const std::size_t length = left.size() < 12 ? 0 : big_endian(left);
    if (left.size() < 12 || length > left.size() - 12) gonio::refuse({name, ": the PNG file is truncated"});
    const std::span<const std::byte> data = left.subspan(8, length);
    const std::span<const std::byte> checked = left.subspan(4, 4 + length);
    if (crc32_z(0, stb_bytes(checked), checked.size()) != big_endian(left.subspan(8 + length)))
      gonio::refuse({name, ": the checksum of a PNG chunk is wrong, the file is damaged"});
    const bool first = type.empty();
    type = {reinterpret_cast<const char*>(checked.data()), 4};
    if (first != (type == "IHDR")) gonio::refuse({name, ": the PNG header is missing or appears twice"});
    if (first) {
      header = read_png_header(data, name);
      check_believable_pixels(png_claims, header.rows, header.columns, bytes.size(), name);
    }
    if (type == "IDAT") pixels.insert(pixels.end(), data.begin(), data.end());
    left = left.subspan(12 + length);
    if (type == "IEND" && !left.empty())
      gonio::refuse({name, ": ", left.size(), " bytes follow the end of the PNG file"});
  }
  check_png_pixels(pixels, header.raw_size(), name);
}

GONIO_INLINE std::array<float, 3> round_to_rgbe(const float* pixel) noexcept {
  const float largest = std::max({pixel[0], pixel[1], pixel[2]});
  if (!(largest > 1e-32f)) return {};
  int exponent = 0;
  static_cast<void>(std::frexp(largest, &exponent));
  if (std::round(std::ldexp(largest, 8 - exponent)) > 255.0f) ++exponent;
  std::array<float, 3> rounded{};
  for (std::size_t channel = 0; channel < 3; ++channel)
    rounded[channel] = std::ldexp(std::round(std::ldexp(std::max(pixel[channel], 0.0f), 8 - exponent)), exponent - 8);
  return rounded;
}

GONIO_INLINE void byte_sink::write(void* user, void* data, int size) noexcept {
  auto& sink = *static_cast<byte_sink*>(user);
  const std::span<const std::byte> more(static_cast<const std::byte*>(data),
                                        static_cast<std::size_t>(std::max(size, 0)));
  try {
    sink.bytes.insert(sink.bytes.end(), more.begin(), more.end());
  } catch (...) {
    sink.failed = true;
  }
}

GONIO_INLINE stb_extents check_pixels(const image& picture, float brightest, const std::string& name) {
  const std::size_t rows = picture.shape(0), columns = picture.shape(1);
  if (picture.shape(2) != 3) gonio::refuse({name, ": an image of ", picture.shape(2), " channels, expected 3"});
  check_image_size(rows, columns, name);
  const auto bad =
      std::find_if(picture.data(), picture.data() + picture.size(), [&](float v) { return !(v <= brightest); });
  if (const auto at = static_cast<std::size_t>(bad - picture.data()); at < picture.size())
    gonio::refuse({name, ": pixel (row ", at / 3 / columns, ", column ", at / 3 % columns, ") is ", *bad,
                   ", which the file cannot hold"});
  return {static_cast<int>(columns), static_cast<int>(rows)};
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE image read_png(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  const std::string name = path.string();
  detail::check_png(bytes, name);
  int columns = 0, rows = 0, channels = 0;
  const detail::stb_pixels<stbi_uc> pixels(
      stbi_load_from_memory(detail::stb_bytes(bytes), detail::stb_size(bytes, name), &columns, &rows, &channels, 3));
  if (!pixels) detail::refuse_by_stb(name);

  std::array<float, 256> linear{};
  for (std::size_t code = 0; code < linear.size(); ++code)
    linear[code] = static_cast<float>(detail::srgb_to_linear(static_cast<double>(code) / 255.0));
  image picture({static_cast<std::size_t>(rows), static_cast<std::size_t>(columns), std::size_t{3}});
  std::transform(pixels.get(), pixels.get() + picture.size(), picture.data(),
                 [&](stbi_uc code) { return linear[code]; });
  return picture;
}

GONIO_INLINE stored_codes read_png_codes(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  const std::string name = path.string();
  detail::check_png(bytes, name);
  const stbi_uc* data = detail::stb_bytes(bytes);
  const int size = detail::stb_size(bytes, name);
  int columns = 0, rows = 0, channels = 0;
  stored_codes codes;
  const auto keep = [&](const auto& pixels) {
    if (!pixels) detail::refuse_by_stb(name);
    codes.rows = static_cast<std::size_t>(rows);
    codes.columns = static_cast<std::size_t>(columns);
    codes.values.assign(pixels.get(), pixels.get() + 3 * codes.rows * codes.columns);
  };
  if (stbi_is_16_bit_from_memory(data, size) != 0) {
    codes.largest = 65535;
    keep(detail::stb_pixels<stbi_us>(stbi_load_16_from_memory(data, size, &columns, &rows, &channels, 3)));
  } else {
    keep(detail::stb_pixels<stbi_uc>(stbi_load_from_memory(data, size, &columns, &rows, &channels, 3)));
  }
  return codes;
}

GONIO_INLINE std::vector<std::byte> write_png(const image& picture, const std::string& name) {
  const auto [columns, rows] = detail::check_pixels(picture, std::numeric_limits<float>::infinity(), name);
  std::vector<stbi_uc> codes(picture.size());
  std::transform(picture.data(), picture.data() + picture.size(), codes.begin(),
                 [](float value) { return static_cast<stbi_uc>(std::lround(255.0 * encode_srgb(double{value}))); });
  detail::byte_sink sink;
  if (stbi_write_png_to_func(detail::byte_sink::write, &sink, columns, rows, 3, codes.data(), 3 * columns) == 0 ||
      sink.failed)
    gonio::refuse({name, ": the image cannot be encoded"});
  return std::move(sink.bytes);
}

GONIO_INLINE void write_png(const std::filesystem::path& path, const image& picture) {
  write_atomically(path, write_png(picture, path.string()));
}

GONIO_INLINE image read_hdr(const std::filesystem::path& path) {
  const hdr_rows file(path);
  image picture({static_cast<std::size_t>(file.rows()), static_cast<std::size_t>(file.columns()), std::size_t{3}});
  file.read({0, file.rows()}, {picture.data(), picture.size()});
  return picture;
}

GONIO_INLINE void write_hdr(const std::filesystem::path& path, const image& picture) {
  constexpr float brightest = 1.69e38f;
  const auto [columns, rows] = detail::check_pixels(picture, brightest, path.string());
  std::vector<float> rounded(picture.size());
  for (std::size_t i = 0; i < rounded.size(); i += 3)
    std::ranges::copy(detail::round_to_rgbe(picture.data() + i), rounded.begin() + i);
  detail::byte_sink sink;
  if (stbi_write_hdr_to_func(detail::byte_sink::write, &sink, columns, rows, 3, rounded.data()) == 0 || sink.failed)
    gonio::refuse({path.string(), ": the image cannot be encoded"});
  write_atomically(path, sink.bytes);
}

}  // namespace gonio::io
