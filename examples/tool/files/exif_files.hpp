#pragma once
/// EXIF data of JPEG files where the tool was built with libexif; elsewhere a refusal that says so.

#include <filesystem>
#include <optional>

namespace cli {

[[nodiscard]] std::optional<double> read_exif_exposure_time(const std::filesystem::path& path);

}  // namespace cli
