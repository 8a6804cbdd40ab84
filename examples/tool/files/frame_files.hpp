#pragma once
/// Photographs in a folder, and how long each was exposed.

#include <gonio/capture/dark_signal.hpp>

#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

namespace cli {

/// How the names of photographs end.
inline constexpr std::array<std::string_view, 5> frame_extensions{".png", ".tif", ".tiff", ".ppm", ".pgm"};

/// All PNG, TIFF, PPM and PGM files of a folder, by name. Their times are those of the table (.csv), or, if it is
/// empty, what their names say, or else their EXIF data. Throws gonio::error naming the file that has no exposure time,
/// cannot be read, or has not the size or the largest count of the first one, and if there is no such file.
[[nodiscard]] std::vector<gonio::capture::exposed_frame> read_frames(const std::filesystem::path& folder,
                                                                     const std::filesystem::path& times);

}  // namespace cli
