#pragma once
/// Bodies of io/exr.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/believable.hpp>
#include <gonio/io/exr.hpp>
#include <gonio/io/file.hpp>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/openexr.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace gonio::io::detail {

/// Bytes in memory, as OpenEXR reads them.
class exr_source : public Imf::IStream {
 public:
  exr_source(std::span<const std::byte> bytes, const std::string& name) : IStream(name.c_str()), bytes_(bytes) {}

  bool read(char to[], int count) override {
    const std::size_t wanted = static_cast<std::size_t>(std::max(count, 0));
    if (wanted > bytes_.size() - at_) throw std::runtime_error("the file is truncated");
    const std::span<const std::byte> some = bytes_.subspan(at_, wanted);
    std::ranges::transform(some, to, [](std::byte each) { return static_cast<char>(each); });
    at_ += wanted;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("the file is truncated");
    at_ = static_cast<std::size_t>(position);
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

/// Collects what OpenEXR writes: it goes back to fill in where the lines are.
class exr_sink : public Imf::OStream {
 public:
  explicit exr_sink(const std::string& name) : OStream(name.c_str()) {}

  void write(const char from[], int count) override {
    const auto end = at_ + static_cast<std::size_t>(count);
    if (bytes.size() < end) bytes.resize(end);
    std::transform(from, from + count, bytes.begin() + static_cast<std::ptrdiff_t>(at_),
                   [](char each) { return static_cast<std::byte>(each); });
    at_ = end;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }

  std::vector<std::byte> bytes;

 private:
  std::size_t at_ = 0;
};

/// More each way is no image of ours.
inline constexpr int exr_limit = 16384;
inline constexpr std::array<const char*, 3> exr_channels{"R", "G", "B"};

/// An image's size, once it is believed. Decoding takes up to 28 bytes a pixel, and 32 lines at a time.
[[nodiscard]] GONIO_INLINE std::array<std::size_t, 2> exr_extents(std::int64_t columns, std::int64_t rows,
                                                                  std::size_t bytes, const std::string& name) {
  if (rows < 1 || columns < 1 || rows > exr_limit || columns > exr_limit)
    gonio::refuse(
        {name, ": an image of ", columns, " x ", rows, " pixels, expected from 1 to ", exr_limit, " each way"});
  const auto pixels = static_cast<std::size_t>(rows * columns);
  if (!hdr_claims.are_believable(pixels, bytes))
    gonio::refuse({name, ": an image of ", columns, " x ", rows, " pixels is not believable of ", bytes, " bytes"});
  return {static_cast<std::size_t>(rows), static_cast<std::size_t>(columns)};
}

/// How OpenEXR's C interface reads bytes in memory.
GONIO_INLINE std::int64_t read_exr_bytes(exr_const_context_t, void* source, void* to, std::uint64_t count,
                                         std::uint64_t offset, exr_stream_error_func_ptr_t) {
  const auto& bytes = *static_cast<const std::span<const std::byte>*>(source);
  if (offset > bytes.size()) return -1;
  const std::size_t some = std::min<std::size_t>(count, bytes.size() - offset);
  if (some > 0) std::memcpy(to, bytes.data() + offset, some);
  return static_cast<std::int64_t>(some);
}
GONIO_INLINE std::int64_t size_of_exr_bytes(exr_const_context_t, void* source) {
  return std::ssize(*static_cast<const std::span<const std::byte>*>(source));
}
GONIO_INLINE void ignore_exr_message(exr_const_context_t, exr_result_t, const char*) {}

/// Refuses a header that claims more than the file has, or lines and tiles that are not believable. OpenEXR's C++
/// interface reserves whatever is claimed; the C interface checks it against the file's size.
GONIO_INLINE void require_sound_exr_header(std::span<const std::byte> bytes, const std::string& name) {
  exr_context_initializer_t given = EXR_DEFAULT_CONTEXT_INITIALIZER;
  given.user_data = &bytes;
  given.read_fn = &read_exr_bytes;
  given.size_fn = &size_of_exr_bytes;
  given.error_handler_fn = &ignore_exr_message;
  given.flags = EXR_CONTEXT_FLAG_STRICT_HEADER;  // otherwise it passes over what it cannot read
  exr_context_t context = nullptr;
  const exr_result_t result = exr_start_read(&context, name.c_str(), &given);
  exr_attr_box2i_t window{};
  std::uint32_t tile_columns = 1, tile_rows = 1;
  if (result == EXR_ERR_SUCCESS) {
    exr_get_data_window(context, 0, &window);
    exr_tile_level_mode_t levels{};
    exr_tile_round_mode_t rounding{};
    exr_get_tile_descriptor(context, 0, &tile_columns, &tile_rows, &levels, &rounding);
  }
  exr_finish(&context);
  if (result != EXR_ERR_SUCCESS)
    gonio::refuse({name, ": cannot be decoded as OpenEXR (", exr_get_default_error_message(result), ")"});
  static_cast<void>(exr_extents(std::int64_t{window.max.x} - window.min.x + 1,
                                std::int64_t{window.max.y} - window.min.y + 1, bytes.size(), name));
  static_cast<void>(exr_extents(std::max(1u, tile_columns), std::max(1u, tile_rows), bytes.size(), name));
}

[[nodiscard]] GONIO_INLINE image decode_exr(std::span<const std::byte> bytes, const std::string& name) {
  // Look at the sizes before anything is decoded.
  require_sound_exr_header(bytes, name);
  exr_source source(bytes, name);
  Imf::InputFile file(source, 0);
  const Imath::Box2i window = file.header().dataWindow();
  const auto [rows, columns] = exr_extents(std::int64_t{window.max.x} - window.min.x + 1,
                                           std::int64_t{window.max.y} - window.min.y + 1, bytes.size(), name);
  const Imf::ChannelList& channels = file.header().channels();
  const bool is_colour =
      std::ranges::all_of(exr_channels, [&](const char* each) { return channels.findChannel(each); });
  if (!is_colour && channels.findChannel("Y") == nullptr)
    gonio::refuse({name, ": has neither channels R, G and B nor Y"});
  // Read each channel to its place.
  const Imath::V2i corner = window.min;
  const std::ptrdiff_t across = 3 * sizeof(float), down = across * static_cast<std::ptrdiff_t>(columns);
  image picture = uniform_image(rows, columns);
  Imf::FrameBuffer buffer;
  for (std::size_t channel = 0; channel < (is_colour ? 3 : 1); ++channel) {
    const char* kind = is_colour ? exr_channels[channel] : "Y";
    const Imf::Channel& stored = channels[kind];
    if (stored.xSampling != 1 || stored.ySampling != 1)
      gonio::refuse({name, ": channel ", kind, " has not a value in each pixel"});
    char* first = reinterpret_cast<char*>(picture.data() + channel);
    buffer.insert(kind, Imf::Slice(Imf::FLOAT, first - corner.x * across - corner.y * down,
                                   static_cast<std::size_t>(across), static_cast<std::size_t>(down)));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  if (!is_colour)
    for (std::size_t i = 0; i < picture.size(); i += 3)
      picture.data()[i + 1] = picture.data()[i + 2] = picture.data()[i];
  return picture;
}

GONIO_INLINE void require_no_nan(const image& picture, const std::string& name) {
  for (std::size_t i = 0; i < picture.size(); ++i)
    if (std::isnan(picture.data()[i]))
      gonio::refuse({name, ": pixel (row ", i / 3 / picture.shape(1), ", column ", i / 3 % picture.shape(1),
                     ") is not a number"});
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE image parse_exr(std::span<const std::byte> bytes, const std::string& name) {
  image picture;
  try {
    picture = detail::decode_exr(bytes, name);
  } catch (const gonio::error&) {
    throw;
  } catch (const std::exception& failure) {
    gonio::refuse({name, ": cannot be decoded as OpenEXR (", failure.what(), ")"});
  }
  detail::require_no_nan(picture, name);
  return picture;
}

GONIO_INLINE image read_exr(const std::filesystem::path& path) { return parse_exr(read_bytes(path), path.string()); }

GONIO_INLINE void write_exr(const std::filesystem::path& path, const image& picture) {
  const std::string name = path.string();
  const std::size_t rows = picture.shape(0), columns = picture.shape(1);
  if (rows < 1 || columns < 1 || rows > detail::exr_limit || columns > detail::exr_limit || picture.shape(2) != 3)
    gonio::refuse({name, ": an image of ", columns, " x ", rows, " pixels and ", picture.shape(2),
                   " channels, expected 3 channels and from 1 to ", detail::exr_limit, " pixels each way"});
  detail::require_no_nan(picture, name);
  detail::exr_sink sink(name);
  try {
    Imf::Header header(static_cast<int>(columns), static_cast<int>(rows));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer buffer;
    const std::size_t across = 3 * sizeof(float);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      header.channels().insert(detail::exr_channels[channel], Imf::Channel(Imf::FLOAT));
      char* first = reinterpret_cast<char*>(const_cast<float*>(picture.data() + channel));  // which it only reads
      buffer.insert(detail::exr_channels[channel], Imf::Slice(Imf::FLOAT, first, across, across * columns));
    }
    Imf::OutputFile file(sink, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(static_cast<int>(rows));
  } catch (const std::exception& failure) {
    gonio::refuse({name, ": the image cannot be encoded (", failure.what(), ")"});
  }
  write_atomically(path, sink.bytes);
}

}  // namespace gonio::io
