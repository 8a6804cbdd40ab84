#pragma once
/// OpenEXR images where the tool was built with OpenEXR; elsewhere a refusal that says so.

#include "image_rows.hpp"
#include <gonio/table/image.hpp>

#include <filesystem>
#include <memory>

namespace cli {

/// Was it?
extern const bool has_exr;

[[nodiscard]] gonio::image read_exr(const std::filesystem::path& path);
/// Read some rows at a time.
[[nodiscard]] std::unique_ptr<image_rows> open_exr(const std::filesystem::path& path);
void write_exr(const std::filesystem::path& path, const gonio::image& picture);

}  // namespace cli
