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

/// At least one, sorted by name; the rest of the folder is ignored. Extensions are given with the dot, in small
/// letters. Throws gonio::error if the folder cannot be read or holds no such file, which may be another folder than is
/// meant, or if two files give the same name: `what` is what errors call such a file.
[[nodiscard]] std::vector<named_file> list_named_files(const std::filesystem::path& folder,
                                                       std::span<const std::string_view> extensions,
                                                       std::string_view what);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/text/impl/named_files.ipp>
#endif
