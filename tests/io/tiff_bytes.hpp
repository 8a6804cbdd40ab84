#pragma once
// TIFF files assembled by hand, so that they can be faulty.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace tiff_bytes {

struct tag {
  std::uint16_t number, type;  ///< 3: short, 4: long, 5: fraction
  std::uint32_t count, value;
};

/// One strip without compression.
struct image {
  std::uint32_t columns = 1, rows = 1;
  std::uint32_t bits = 8, channels = 3;
  std::uint32_t meaning = 2;  ///< photometric interpretation: RGB
  std::uint32_t compression = 1;
  std::vector<std::uint16_t> samples = {};
  std::optional<std::pair<std::uint32_t, std::uint32_t>> exposure = {};  ///< numerator and denominator
  std::vector<tag> more = {};  ///< more tags; replace those of the same number
};

/// Little-endian bytes.
class writer {
 public:
  void put(std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i) & 0xFF));
  }
  void put(const std::vector<tag>& tags) {
    put(static_cast<std::uint32_t>(tags.size()), 2);
    for (const tag& each : tags) {
      put(each.number, 2);
      put(each.type, 2);
      put(each.count, 4);
      put(each.value, 4);
    }
    put(0, 4);
  }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(bytes.size()); }

  std::vector<std::byte> bytes;
};

/// Writes the EXIF directory with an exposure time; `at` is its offset in the file.
inline void put_exif(writer& file, const std::pair<std::uint32_t, std::uint32_t>& exposure, std::uint32_t at) {
  constexpr std::uint32_t directory = 2 + 12 + 4;
  file.put({{33434, 5, 1, at + directory}});
  file.put(exposure.first, 4);
  file.put(exposure.second, 4);
}

[[nodiscard]] inline std::vector<std::byte> of(const image& picture) {
  writer file;
  file.put(0x002A4949, 4);
  file.put(0, 4);  // the directory's offset, set below
  const std::uint32_t pixels = file.size();
  for (const std::uint16_t sample : picture.samples) file.put(sample, picture.bits == 8 ? 1 : 2);
  const std::uint32_t pixel_bytes = file.size() - pixels;
  if (file.size() % 2 == 1) file.put(0, 1);
  // Bits of several channels do not fit into a tag.
  const std::uint32_t bits = file.size();
  for (std::uint32_t i = 0; i < picture.channels; ++i) file.put(picture.bits, 2);
  const std::uint32_t exif = file.size();
  if (picture.exposure) put_exif(file, *picture.exposure, exif);
  const std::uint32_t directory = file.size();
  for (int i = 0; i < 4; ++i)
    file.bytes[4 + static_cast<std::size_t>(i)] = static_cast<std::byte>(directory >> (8 * i));

  const bool are_inside = picture.channels <= 2;
  std::vector<tag> tags{{256, 4, 1, picture.columns},
                        {257, 4, 1, picture.rows},
                        {258, 3, picture.channels, are_inside ? picture.bits : bits},
                        {259, 3, 1, picture.compression},
                        {262, 3, 1, picture.meaning},
                        {273, 4, 1, pixels},
                        {277, 3, 1, picture.channels},
                        {278, 4, 1, picture.rows},
                        {279, 4, 1, pixel_bytes}};
  if (picture.exposure) tags.push_back({34665, 4, 1, exif});
  for (const tag& each : picture.more) {
    std::erase_if(tags, [&](const tag& old) { return old.number == each.number; });
    tags.push_back(each);
  }
  std::ranges::sort(tags, {}, &tag::number);
  file.put(tags);
  return file.bytes;
}

/// A JPEG file with only EXIF data.
[[nodiscard]] inline std::vector<std::byte> jpeg_of(
    const std::optional<std::pair<std::uint32_t, std::uint32_t>>& exposure) {
  writer exif;
  exif.put(0x002A4949, 4);
  exif.put(8, 4);
  exif.put({{34665, 4, 1, 8 + 2 + 12 + 4}});
  if (exposure)
    put_exif(exif, *exposure, exif.size());
  else
    exif.put(std::vector<tag>{{34850, 3, 1, 1}});  // an exposure program
  writer file;
  file.put(0xE1FFD8FF, 4);  // start of the image, and of an application segment
  const std::uint32_t length = exif.size() + 8;
  file.put(length >> 8, 1);
  file.put(length & 0xFF, 1);
  for (const char letter : {'E', 'x', 'i', 'f', '\0', '\0'}) file.put(static_cast<std::uint32_t>(letter), 1);
  file.bytes.insert(file.bytes.end(), exif.bytes.begin(), exif.bytes.end());
  file.put(0xD9FF, 2);
  return file.bytes;
}

}  // namespace tiff_bytes
