#pragma once
/// Photographs in a folder, and their exposure times.

#include <gonio/capture/dark_signal.hpp>

#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

namespace cli {

/// The extensions of photographs.
inline constexpr std::array<std::string_view, 5> frame_extensions{".png", ".tif", ".tiff", ".ppm", ".pgm"};

/// Reads all PNG, TIFF, PPM and PGM files of a folder, ordered by name. Exposure times come from the table `times`
/// (.csv); without a table, from the names or else from EXIF data. Throws gonio::error if the folder has no such file.
/// Throws an error that names the file if a file has no exposure time, cannot be read, or differs from the first file
/// in size or largest count.
[[nodiscard]] std::vector<gonio::capture::exposed_frame> read_frames(const std::filesystem::path& folder,
                                                                     const std::filesystem::path& times);

}  // namespace cli
