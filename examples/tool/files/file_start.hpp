#pragma once
/// What a file is recognised by: how it begins, and its extension.

#include <filesystem>
#include <string>

namespace cli {

/// Its first 65,536 bytes, or all if it has fewer; nothing if it cannot be opened, or is no regular file: its reader
/// then says why.
[[nodiscard]] std::string file_start(const std::filesystem::path& path);

/// Its extension with the dot, in lower case.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);

}  // namespace cli
