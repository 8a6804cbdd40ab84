#pragma once
/// EXIF data of JPEG files. Without libexif, the function throws gonio::error.

#include <filesystem>
#include <optional>

namespace cli {

/// Returns the exposure time in seconds, if the file has one.
[[nodiscard]] std::optional<double> read_exif_exposure_time(const std::filesystem::path& path);

}  // namespace cli
