#pragma once
/// OpenEXR images. Without OpenEXR, the functions throw gonio::error.

#include "image_rows.hpp"
#include <gonio/table/image.hpp>

#include <filesystem>
#include <memory>

namespace cli {

/// Was the tool built with OpenEXR?
extern const bool has_exr;

[[nodiscard]] gonio::image read_exr(const std::filesystem::path& path);
/// Opens an image to read some rows at a time.
[[nodiscard]] std::unique_ptr<image_rows> open_exr(const std::filesystem::path& path);
void write_exr(const std::filesystem::path& path, const gonio::image& picture);

}  // namespace cli
