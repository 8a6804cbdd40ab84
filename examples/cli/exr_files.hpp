#pragma once
/// OpenEXR images where the tool was built with OpenEXR; elsewhere a refusal that says so.

#include <gonio/table/image.hpp>

#include <filesystem>

namespace cli {

[[nodiscard]] gonio::image read_exr(const std::filesystem::path& path);
void write_exr(const std::filesystem::path& path, const gonio::image& picture);

}  // namespace cli
