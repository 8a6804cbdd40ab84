#pragma once
/// Bodies of io/images/exr.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/believable.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/images/exr.hpp>

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
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// The bytes of an OpenEXR file, in memory or in an open file.
struct exr_input {
  std::string name;
  std::uint64_t size;
  /// Reads from an offset until `bytes` is full or the data ends; returns the number of bytes read.
  std::function<std::size_t(std::uint64_t offset, std::span<std::byte> bytes)> read;
};

[[nodiscard]] GONIO_INLINE exr_input exr_in_memory(std::span<const std::byte> bytes, const std::string& name) {
  return {name, bytes.size(), [bytes](std::uint64_t offset, std::span<std::byte> out) {
            const auto begin = static_cast<std::size_t>(std::min<std::uint64_t>(offset, bytes.size()));
            const auto some = bytes.subspan(begin, std::min(out.size(), bytes.size() - begin));
            std::ranges::copy(some, out.begin());
            return some.size();
          }};
}

[[nodiscard]] GONIO_INLINE exr_input exr_in_file(const std::filesystem::path& path) {
  const auto file = std::make_shared<descriptor>(open_to_read(path));
  return {path.string(), size_of_regular(*file, path),
          [file, path](std::uint64_t offset, std::span<std::byte> out) { return read_at(*file, offset, out, path); }};
}

/// The input of OpenEXR's C++ interface.
class exr_source : public Imf::IStream {
 public:
  explicit exr_source(const exr_input& input) : IStream(input.name.c_str()), input_(input) {}

  bool read(char to[], int count) override {
    const std::span<char> wanted(to, static_cast<std::size_t>(std::max(count, 0)));
    if (input_.read(at_, std::as_writable_bytes(wanted)) != wanted.size())
      throw std::runtime_error("the file is truncated");
    at_ += wanted.size();
    return at_ < input_.size;
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override {
    if (position > input_.size) throw std::runtime_error("the file is truncated");
    at_ = position;
  }

 private:
  const exr_input& input_;
  std::uint64_t at_ = 0;
};

/// Collects OpenEXR's output, which seeks back to fill in the positions of the lines.
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

inline constexpr int exr_limit = 16384;
inline constexpr std::array<const char*, 3> exr_channels{"R", "G", "B"};

/// Returns an image's rows and columns; refuses an implausible size. Decoding takes up to 28 bytes per pixel.
[[nodiscard]] GONIO_INLINE std::array<std::size_t, 2> exr_extents(std::int64_t columns, std::int64_t rows,
                                                                  std::size_t bytes, const std::string& name) {
  if (rows < 1 || columns < 1 || rows > exr_limit || columns > exr_limit)
    gonio::refuse(
        {name, ": an image of ", columns, " x ", rows, " pixels, expected from 1 to ", exr_limit, " each way"});
  const auto pixels = static_cast<std::size_t>(rows * columns);
  if (!hdr_claims.are_believable(pixels, bytes))
    gonio::refuse({name, ": an image of ", columns, " x ", rows, " pixels cannot fit in ", bytes, " bytes"});
  return {static_cast<std::size_t>(rows), static_cast<std::size_t>(columns)};
}

/// The read callback of OpenEXR's C interface.
GONIO_INLINE std::int64_t read_exr_bytes(exr_const_context_t, void* input, void* to, std::uint64_t count,
                                         std::uint64_t offset, exr_stream_error_func_ptr_t) try {
  const std::span<std::byte> out(static_cast<std::byte*>(to), static_cast<std::size_t>(count));
  return static_cast<std::int64_t>(static_cast<const exr_input*>(input)->read(offset, out));
} catch (const std::exception&) {
  return -1;
}
GONIO_INLINE std::int64_t size_of_exr_bytes(exr_const_context_t, void* input) {
  return static_cast<std::int64_t>(static_cast<const exr_input*>(input)->size);
}
GONIO_INLINE void ignore_exr_message(exr_const_context_t, exr_result_t, const char*) {}

/// A file's header and the positions of its blocks, read through OpenEXR's C interface without decoding. The C++
/// interface allocates whatever a file claims; the C interface checks the claim against the file's size.
class exr_outline {
 public:
  explicit exr_outline(exr_input& input) : input_(input) {
    exr_context_initializer_t given = EXR_DEFAULT_CONTEXT_INITIALIZER;
    given.user_data = &input;
    given.read_fn = &read_exr_bytes;
    given.size_fn = &size_of_exr_bytes;
    given.error_handler_fn = &ignore_exr_message;
    given.flags = EXR_CONTEXT_FLAG_STRICT_HEADER;  // otherwise unreadable attributes are skipped
    const exr_result_t result = exr_start_read(&context_, input.name.c_str(), &given);
    if (result != EXR_ERR_SUCCESS) {
      exr_finish(&context_);
      refuse(result);
    }
    exr_get_data_window(context_, 0, &window_);
    exr_tile_level_mode_t levels{};
    exr_tile_round_mode_t rounding{};
    is_tiled_ =
        exr_get_tile_descriptor(context_, 0, &tile_columns_, &tile_rows_, &levels, &rounding) == EXR_ERR_SUCCESS;
  }
  exr_outline(const exr_outline&) = delete;
  exr_outline& operator=(const exr_outline&) = delete;
  ~exr_outline() { exr_finish(&context_); }

  /// Refuses an implausible size of the image or of its tiles.
  void require_believable() const {
    static_cast<void>(exr_extents(std::int64_t{window_.max.x} - window_.min.x + 1,
                                  std::int64_t{window_.max.y} - window_.min.y + 1, input_.size, input_.name));
    static_cast<void>(exr_extents(std::max(1u, tile_columns_), std::max(1u, tile_rows_), input_.size, input_.name));
  }

  /// Refuses a file with missing blocks, and tiles so large that a row of them takes too much memory.
  void require_blocks() const {
    constexpr std::uint32_t most_rows = 512;
    if (is_tiled_ && tile_rows_ > most_rows)
      gonio::refuse({input_.name, ": its tiles have ", std::int64_t{tile_rows_},
                     " rows, expected scan lines or tiles of at most ", std::int64_t{most_rows}, " rows"});
    exr_chunk_info_t block{};
    if (is_tiled_) {
      int across = 0, down = 0;
      exr_get_level_sizes(context_, 0, 0, 0, &across, &down);
      for (int y = 0; y * std::int64_t{tile_rows_} < down; ++y)
        for (int x = 0; x * std::int64_t{tile_columns_} < across; ++x)
          require(exr_read_tile_chunk_info(context_, 0, x, y, 0, 0, &block));
      return;
    }
    int lines = 1;
    exr_get_scanlines_per_chunk(context_, 0, &lines);
    for (std::int64_t y = window_.min.y; y <= window_.max.y; y += std::max(lines, 1))
      require(exr_read_scanline_chunk_info(context_, 0, static_cast<int>(y), &block));
  }

 private:
  void require(exr_result_t result) const {
    if (result != EXR_ERR_SUCCESS) refuse(result);
  }
  [[noreturn]] void refuse(exr_result_t result) const {
    gonio::refuse({input_.name, ": cannot be decoded as OpenEXR (", exr_get_default_error_message(result), ")"});
  }

  const exr_input& input_;
  exr_context_t context_ = nullptr;
  exr_attr_box2i_t window_{};
  std::uint32_t tile_columns_ = 1, tile_rows_ = 1;
  bool is_tiled_ = false;
};

/// Calls `act` and adds the file's name to OpenEXR's exceptions.
template <class Act>
auto naming_exr(const std::string& name, const Act& act) {
  try {
    return act();
  } catch (const gonio::error&) {
    throw;
  } catch (const std::exception& failure) {
    gonio::refuse({name, ": cannot be decoded as OpenEXR (", failure.what(), ")"});
  }
}

/// An OpenEXR file whose header is valid.
class exr_decoder {
 public:
  explicit exr_decoder(exr_input input) : input_(std::move(input)), source_(input_) {
    exr_outline(input_).require_believable();
    naming_exr(input_.name, [&] { open(); });
  }

  [[nodiscard]] std::size_t rows() const noexcept { return extents_[0]; }
  [[nodiscard]] std::size_t columns() const noexcept { return extents_[1]; }
  void require_blocks() { exr_outline(input_).require_blocks(); }

  void read(block rows, std::span<float> out) {
    naming_exr(input_.name, [&] { decode(rows, out); });
    if (!is_colour_)
      for (std::size_t i = 0; i < out.size(); i += 3) out[i + 1] = out[i + 2] = out[i];
  }

 private:
  void open() {
    file_.emplace(source_, 0);
    const Imath::Box2i window = file_->header().dataWindow();
    corner_ = window.min;
    extents_ = exr_extents(std::int64_t{window.max.x} - window.min.x + 1, std::int64_t{window.max.y} - window.min.y + 1,
                           input_.size, input_.name);
    const Imf::ChannelList& channels = file_->header().channels();
    is_colour_ = std::ranges::all_of(exr_channels, [&](const char* each) { return channels.findChannel(each); });
    if (!is_colour_ && channels.findChannel("Y") == nullptr)
      gonio::refuse({input_.name, ": has neither channels R, G and B nor Y"});
    for (const char* kind : kinds())
      if (channels[kind].xSampling != 1 || channels[kind].ySampling != 1)
        gonio::refuse({input_.name, ": channel ", kind, " does not have a value in each pixel"});
  }

  [[nodiscard]] std::span<const char* const> kinds() const noexcept {
    static constexpr std::array<const char*, 1> grey{"Y"};
    return is_colour_ ? std::span<const char* const>(exr_channels) : std::span<const char* const>(grey);
  }

  void decode(block rows, std::span<float> out) {
    const std::ptrdiff_t across = 3 * sizeof(float), down = across * static_cast<std::ptrdiff_t>(columns());
    const int first = corner_.y + static_cast<int>(rows.begin);
    Imf::FrameBuffer buffer;
    float* to = out.data();
    for (const char* kind : kinds())
      buffer.insert(kind, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(to++) - corner_.x * across - first * down,
                                     static_cast<std::size_t>(across), static_cast<std::size_t>(down)));
    file_->setFrameBuffer(buffer);
    file_->readPixels(first, corner_.y + static_cast<int>(rows.end) - 1);
  }

  exr_input input_;
  exr_source source_;
  std::optional<Imf::InputFile> file_;
  Imath::V2i corner_;
  std::array<std::size_t, 2> extents_{};
  bool is_colour_ = false;
};

GONIO_INLINE void require_no_nan(const image& picture, const std::string& name) {
  for (std::size_t i = 0; i < picture.size(); ++i)
    if (std::isnan(picture.data()[i]))
      gonio::refuse({name, ": pixel (row ", i / 3 / picture.shape(1), ", column ", i / 3 % picture.shape(1),
                     ") is not a number"});
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE image read_exr(std::span<const std::byte> bytes, const std::string& name) {
  detail::exr_decoder file(detail::exr_in_memory(bytes, name));
  image picture = uniform_image(file.rows(), file.columns());
  file.read({0, static_cast<Eigen::Index>(file.rows())}, {picture.data(), picture.size()});
  detail::require_no_nan(picture, name);
  return picture;
}

GONIO_INLINE image read_exr(const std::filesystem::path& path) { return read_exr(read_bytes(path), path.string()); }

GONIO_INLINE exr_rows::exr_rows(const std::filesystem::path& path)
    : decoder_(std::make_unique<detail::exr_decoder>(detail::exr_in_file(path))) {
  decoder_->require_blocks();
}
GONIO_INLINE exr_rows::exr_rows(exr_rows&&) noexcept = default;
GONIO_INLINE exr_rows& exr_rows::operator=(exr_rows&&) noexcept = default;
GONIO_INLINE exr_rows::~exr_rows() = default;

GONIO_INLINE Eigen::Index exr_rows::rows() const noexcept { return static_cast<Eigen::Index>(decoder_->rows()); }
GONIO_INLINE Eigen::Index exr_rows::columns() const noexcept { return static_cast<Eigen::Index>(decoder_->columns()); }
GONIO_INLINE void exr_rows::read(block rows, std::span<float> out) const { decoder_->read(rows, out); }

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
      char* first = reinterpret_cast<char*>(const_cast<float*>(picture.data() + channel));  // OpenEXR only reads it
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
