#pragma once
/// The descriptions of `gonio info` for renderers' materials.

#include "json.hpp"

#include <filesystem>

namespace cli {

[[nodiscard]] json describe_rgl(const std::filesystem::path& path);
[[nodiscard]] json describe_mbsdf(const std::filesystem::path& path);
[[nodiscard]] json describe_utia(const std::filesystem::path& path);

}  // namespace cli
