#pragma once
/// The files of a folder that have one of some extensions, in small letters or capitals, by their names without it.

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

/// Extensions are given with the dot, in small letters. Sorted by name; the rest of the folder is ignored. Throws
/// gonio::error if the folder cannot be read, or if two files give the same name, of which there may be one only:
/// `what` is what errors call such a file.
[[nodiscard]] std::vector<named_file> list_named_files(const std::filesystem::path& folder,
                                                       std::span<const std::string_view> extensions,
                                                       std::string_view what);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/impl/named_files.ipp>
#endif
