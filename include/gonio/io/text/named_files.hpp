#pragma once
/// Lists the files of a folder with given extensions, in lower or upper case, by their names without extension.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

struct named_file {
  std::string name;
  std::filesystem::path path;
};

/// Returns the folder's files with these extensions, sorted by name. Extensions include the dot and are in lower case.
/// Throws gonio::error if the folder cannot be read, if it holds no such file, or if two of them have the same name.
/// Errors call the files `what`.
[[nodiscard]] std::vector<named_file> list_named_files(const std::filesystem::path& folder,
                                                       std::span<const std::string_view> extensions,
                                                       std::string_view what);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/named_files.ipp>
#endif
