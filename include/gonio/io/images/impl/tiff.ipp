#pragma once
/// Bodies of io/images/tiff.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/bytes/believable.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/images/exposure_times.hpp>
#include <gonio/io/images/tiff.hpp>

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// Bytes in memory as the input of libtiff, and its first error.
class tiff_source {
 public:
  explicit tiff_source(std::span<const std::byte> bytes) : bytes_(bytes) {}

  [[nodiscard]] const std::string& failure() const noexcept { return failure_; }

  static tmsize_t read(thandle_t self, void* to, tmsize_t count) {
    tiff_source& source = *static_cast<tiff_source*>(self);
    const std::size_t left = source.bytes_.size() - std::min(source.at_, source.bytes_.size());
    const std::size_t copied = std::min(static_cast<std::size_t>(std::max<tmsize_t>(count, 0)), left);
    if (copied > 0) std::memcpy(to, source.bytes_.data() + source.at_, copied);
    source.at_ += copied;
    return static_cast<tmsize_t>(copied);
  }
  static tmsize_t write(thandle_t, void*, tmsize_t) { return 0; }
  static toff_t seek(thandle_t self, toff_t offset, int whence) {
    tiff_source& source = *static_cast<tiff_source*>(self);
    const toff_t from = whence == SEEK_CUR ? source.at_ : whence == SEEK_END ? source.bytes_.size() : 0;
    source.at_ = static_cast<std::size_t>(from + offset);
    return source.at_;
  }
  static int close(thandle_t) { return 0; }
  static toff_t size(thandle_t self) { return static_cast<tiff_source*>(self)->bytes_.size(); }

  static int fail(TIFF*, void* self, const char*, const char* format, va_list arguments) {
    std::array<char, 256> text{};
    std::vsnprintf(text.data(), text.size(), format, arguments);
    std::string& failure = static_cast<tiff_source*>(self)->failure_;
    if (failure.empty()) failure = printable(text.data());
    return 1;
  }
  /// Ignores unknown tags. Refuses byte counts that contradict the image's size, although libtiff can correct them.
  static int warn(TIFF* file, void* self, const char* module, const char* format, va_list arguments) {
    if (std::string_view(format).starts_with("Bogus")) return fail(file, self, module, format, arguments);
    return 1;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  std::string failure_;
};

using tiff_file = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

[[nodiscard]] GONIO_INLINE tiff_file open_tiff(tiff_source& source, const std::string& name) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 &TIFFOpenOptionsFree);
  constexpr tmsize_t most_at_once = tmsize_t{256} << 20;
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), most_at_once);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), &tiff_source::fail, &source);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), &tiff_source::warn, &source);
  // The mode m turns memory mapping off: reading at a wrong offset then returns too few bytes instead of crashing.
  tiff_file file(
      TIFFClientOpenExt(name.c_str(), "rm", &source, &tiff_source::read, &tiff_source::write, &tiff_source::seek,
                        &tiff_source::close, &tiff_source::size, nullptr, nullptr, options.get()),
      &TIFFClose);
  if (!file) gonio::refuse({name, ": is not a TIFF file (", source.failure(), ")"});
  return file;
}

/// Returns a tag of the first image, or its default if it is missing.
[[nodiscard]] GONIO_INLINE unsigned short_tag(TIFF* file, std::uint32_t tag) {
  std::uint16_t value = 0;
  return TIFFGetFieldDefaulted(file, tag, &value) == 1 ? value : 0u;
}

struct tiff_layout {
  std::size_t rows = 0, columns = 0;
  unsigned bits = 0, channels = 0;
};

/// Returns the layout of a supported image. Refuses any other image and states the reason.
[[nodiscard]] GONIO_INLINE tiff_layout layout_of(TIFF* file, std::size_t bytes, const std::string& name) {
  const auto require = [&](bool fine, std::initializer_list<message_part> what) {
    if (!fine) gonio::refuse({name, ": ", message_of(what)});
  };
  std::uint32_t columns = 0, rows = 0;
  require(TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &columns) == 1 && TIFFGetField(file, TIFFTAG_IMAGELENGTH, &rows) == 1,
          {"the TIFF image does not state its size"});
  constexpr std::uint32_t most = 16384;
  require(rows >= 1 && columns >= 1 && rows <= most && columns <= most,
          {"an image of ", columns, " x ", rows, " pixels, expected from 1 to ", most, " each way"});
  const std::size_t pixels = std::size_t{rows} * columns;
  require(png_claims.are_believable(pixels, bytes),
          {"an image of ", columns, " x ", rows, " pixels cannot fit in ", bytes, " bytes"});
  require(TIFFIsTiled(file) == 0, {"the TIFF image is tiled, expected strips"});
  const unsigned bits = short_tag(file, TIFFTAG_BITSPERSAMPLE), channels = short_tag(file, TIFFTAG_SAMPLESPERPIXEL);
  require(bits == 8 || bits == 16, {"the TIFF image has ", bits, " bits a sample, expected 8 or 16"});
  require(short_tag(file, TIFFTAG_SAMPLEFORMAT) == SAMPLEFORMAT_UINT,
          {"the TIFF image's samples are not unsigned integers"});
  require(channels == 1 || short_tag(file, TIFFTAG_PLANARCONFIG) == PLANARCONFIG_CONTIG,
          {"the TIFF image has planar channels, expected interleaved ones"});
  const unsigned meaning = short_tag(file, TIFFTAG_PHOTOMETRIC);
  const bool is_grey = meaning == PHOTOMETRIC_MINISBLACK && channels >= 1;
  require(is_grey || (meaning == PHOTOMETRIC_RGB && channels >= 3),
          {"the TIFF image is neither RGB nor grey: its photometric interpretation is ", meaning, ", with ", channels,
           channels == 1 ? " channel" : " channels"});
  const unsigned compression = short_tag(file, TIFFTAG_COMPRESSION);
  require(TIFFIsCODECConfigured(static_cast<std::uint16_t>(compression)) == 1,
          {"the TIFF image has a compression that this libtiff does not support, number ", compression});
  return {rows, columns, bits, channels};
}

/// Copies the counts of a line, three for each pixel.
template <class Count>
void copy_line(const std::byte* line, const tiff_layout& layout, bool is_grey, std::uint16_t* onto) {
  for (std::size_t column = 0; column < layout.columns; ++column)
    for (std::size_t channel = 0; channel < 3; ++channel) {
      Count count;
      std::memcpy(&count, line + sizeof(Count) * (column * layout.channels + (is_grey ? 0 : channel)), sizeof count);
      onto[3 * column + channel] = count;
    }
}

[[nodiscard]] GONIO_INLINE std::optional<double> exposure_of_exif(TIFF* file) {
  const TIFFField* field = TIFFFindField(file, EXIFTAG_EXPOSURETIME, TIFF_ANY);
  if (field == nullptr) return {};
  // libtiff returns a fraction as a float or as a double.
  if (TIFFFieldSetGetSize(field) == sizeof(float)) {
    float seconds = 0.0f;
    return TIFFGetField(file, EXIFTAG_EXPOSURETIME, &seconds) == 1 ? std::optional<double>(seconds) : std::nullopt;
  }
  double seconds = 0.0;
  return TIFFGetField(file, EXIFTAG_EXPOSURETIME, &seconds) == 1 ? std::optional(seconds) : std::nullopt;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE stored_codes read_tiff(std::span<const std::byte> bytes, const std::string& name) {
  detail::tiff_source source(bytes);
  const detail::tiff_file file = detail::open_tiff(source, name);
  const detail::tiff_layout layout = detail::layout_of(file.get(), bytes.size(), name);
  if (!source.failure().empty()) gonio::refuse({name, ": the TIFF file is damaged (", source.failure(), ")"});
  const bool is_grey = detail::short_tag(file.get(), TIFFTAG_PHOTOMETRIC) == PHOTOMETRIC_MINISBLACK;
  std::vector<std::byte> line(static_cast<std::size_t>(TIFFScanlineSize64(file.get())));
  if (line.size() < layout.columns * layout.channels * layout.bits / 8)
    gonio::refuse({name, ": the TIFF image's lines are too short for its size"});
  stored_codes codes{layout.rows, layout.columns, static_cast<std::uint16_t>((1u << layout.bits) - 1u), {}};
  codes.values.resize(3 * layout.rows * layout.columns);
  for (std::size_t row = 0; row < layout.rows; ++row) {
    if (TIFFReadScanline(file.get(), line.data(), static_cast<std::uint32_t>(row), 0) != 1)
      gonio::refuse({name, ": row ", row, " of the TIFF image cannot be read (", source.failure(), ")"});
    std::uint16_t* onto = codes.values.data() + 3 * row * layout.columns;
    if (layout.bits == 8)
      detail::copy_line<std::uint8_t>(line.data(), layout, is_grey, onto);
    else
      detail::copy_line<std::uint16_t>(line.data(), layout, is_grey, onto);
  }
  return codes;
}

GONIO_INLINE stored_codes read_tiff(const std::filesystem::path& path) {
  return read_tiff(read_bytes(path), path.string());
}

GONIO_INLINE std::optional<double> read_tiff_exposure_time(std::span<const std::byte> bytes, const std::string& name) {
  detail::tiff_source source(bytes);
  const detail::tiff_file file = detail::open_tiff(source, name);
  toff_t offset = 0;
  if (TIFFGetField(file.get(), TIFFTAG_EXIFIFD, &offset) != 1) return {};
  if (TIFFReadEXIFDirectory(file.get(), offset) != 1)
    gonio::refuse({name, ": the EXIF data cannot be read (", source.failure(), ")"});
  const std::optional<double> seconds = detail::exposure_of_exif(file.get());
  if (seconds) require_believable_exposure(*seconds, name);
  return seconds;
}

GONIO_INLINE std::optional<double> read_tiff_exposure_time(const std::filesystem::path& path) {
  return read_tiff_exposure_time(read_bytes(path), path.string());
}

}  // namespace gonio::io
