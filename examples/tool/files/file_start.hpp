#pragma once
/// Recognition of files: by their start and their extension.

#include <filesystem>
#include <string>

namespace cli {

/// Returns the first 65,536 bytes of a file, or all if it has fewer; nothing if it cannot be opened or is not a regular
/// file (its reader then gives the reason).
[[nodiscard]] std::string file_start(const std::filesystem::path& path);

/// Returns the extension with the dot, in lower case.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);

}  // namespace cli
