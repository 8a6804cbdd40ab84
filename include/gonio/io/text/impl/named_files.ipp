#pragma once
/// Bodies of io/text/named_files.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/text/named_files.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace gonio::io {

GONIO_INLINE std::vector<named_file> list_named_files(const std::filesystem::path& folder,
                                                      std::span<const std::string_view> extensions,
                                                      std::string_view what) {
  std::error_code failure;
  std::vector<named_file> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    const std::string file = entry.path().filename().string();
    const std::string lower = lower_case(file);
    for (const std::string_view ending : extensions)
      if (lower.ends_with(ending) && file.size() > ending.size())
        files.push_back({file.substr(0, file.size() - ending.size()), entry.path()});
  }
  if (failure) gonio::refuse({folder.string(), ": cannot be read as a folder: ", failure.message()});
  if (files.empty()) gonio::refuse({folder.string(), ": holds no ", what, " (", listed(extensions, " or "), ")"});
  std::ranges::sort(files, {}, &named_file::name);
  const auto twice = std::ranges::adjacent_find(files, {}, &named_file::name);
  if (twice != files.end())
    gonio::refuse({folder.string(), ": two files differ only in their extension: '", twice->name, "'"});
  return files;
}

}  // namespace gonio::io
