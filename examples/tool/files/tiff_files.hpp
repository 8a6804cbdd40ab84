#pragma once
/// TIFF frames if the tool was built with libtiff; otherwise throws gonio::error.

#include <gonio/table/stored_codes.hpp>

#include <filesystem>
#include <optional>

namespace cli {

[[nodiscard]] gonio::stored_codes read_tiff(const std::filesystem::path& path);
[[nodiscard]] std::optional<double> read_tiff_exposure_time(const std::filesystem::path& path);

}  // namespace cli
