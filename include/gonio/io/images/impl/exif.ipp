#pragma once
/// Bodies of io/images/exif.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/images/exif.hpp>
#include <gonio/io/images/exposure_times.hpp>

#include <libexif/exif-data.h>

#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace gonio::io {

GONIO_INLINE std::optional<double> read_exif_exposure_time(std::span<const std::byte> bytes, const std::string& name) {
  constexpr std::size_t most = std::size_t{1} << 30;  // libexif counts in 32 bits
  if (bytes.size() < 2 || bytes[0] != std::byte{0xFF} || bytes[1] != std::byte{0xD8} || bytes.size() > most)
    gonio::refuse({name, ": is not a JPEG file"});
  const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
  const std::unique_ptr<ExifData, decltype(&exif_data_unref)> data(
      exif_data_new_from_data(first, static_cast<unsigned>(bytes.size())), &exif_data_unref);
  if (!data || data->ifd[EXIF_IFD_0]->count + data->ifd[EXIF_IFD_EXIF]->count == 0)
    gonio::refuse({name, ": has no EXIF data"});
  const ExifEntry* entry = exif_content_get_entry(data->ifd[EXIF_IFD_EXIF], EXIF_TAG_EXPOSURE_TIME);
  if (entry == nullptr) return {};
  if (entry->format != EXIF_FORMAT_RATIONAL || entry->components != 1 || entry->size < 8 || entry->data == nullptr)
    gonio::refuse({name, ": the exposure time in its EXIF data is not a fraction"});
  const ExifRational fraction = exif_get_rational(entry->data, exif_data_get_byte_order(data.get()));
  const double seconds = fraction.denominator == 0 ? std::numeric_limits<double>::infinity()
                                                   : static_cast<double>(fraction.numerator) / fraction.denominator;
  require_believable_exposure(seconds, name);
  return seconds;
}

GONIO_INLINE std::optional<double> read_exif_exposure_time(const std::filesystem::path& path) {
  return read_exif_exposure_time(read_bytes(path), path.string());
}

}  // namespace gonio::io
