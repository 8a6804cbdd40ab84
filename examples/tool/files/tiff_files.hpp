#pragma once
/// TIFF frames. Without libtiff, the functions throw gonio::error.

#include <gonio/table/stored_codes.hpp>

#include <filesystem>
#include <optional>

namespace cli {

[[nodiscard]] gonio::stored_codes read_tiff(const std::filesystem::path& path);
/// Returns the exposure time in seconds, if the file has one.
[[nodiscard]] std::optional<double> read_tiff_exposure_time(const std::filesystem::path& path);

}  // namespace cli
