#pragma once
/// EXIF data of JPEG files if the tool was built with libexif; otherwise throws gonio::error.

#include <filesystem>
#include <optional>

namespace cli {

[[nodiscard]] std::optional<double> read_exif_exposure_time(const std::filesystem::path& path);

}  // namespace cli
