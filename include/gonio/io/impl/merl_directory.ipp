#pragma once
/// Bodies of io/merl_directory.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/io/merl_directory.hpp>
#include <gonio/io/merl_gzip.hpp>
#include <gonio/table/material_set.hpp>

#include <algorithm>

namespace gonio::io {

GONIO_INLINE std::vector<merl_file> list_merl_directory(const std::filesystem::path& folder) {
  std::error_code failure;
  std::vector<merl_file> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    const std::string file = entry.path().filename().string();
    for (const std::string_view ending : {".binary", ".binary.gz"})
      if (file.ends_with(ending) && file.size() > ending.size())
        files.push_back({file.substr(0, file.size() - ending.size()), entry.path()});
  }
  if (failure) gonio::refuse({folder.string(), ": cannot be read as a folder: ", failure.message()});
  std::ranges::sort(files, {}, &merl_file::name);
  const auto twice = std::ranges::adjacent_find(files, {}, &merl_file::name);
  if (twice != files.end()) gonio::refuse({folder.string(), ": two tables are named '", twice->name, "'"});
  return files;
}

GONIO_INLINE material_set read_merl_directory(const std::filesystem::path& folder,
                                              const std::vector<std::string>& excluded, const progress& listener) {
  std::vector<merl_file> files = list_merl_directory(folder);
  for (const std::string& name : excluded)
    if (std::erase_if(files, [&](const merl_file& file) { return file.name == name; }) == 0)
      gonio::refuse({folder.string(), ": there is no table named '", name, "' to exclude"});
  if (files.empty()) gonio::refuse({folder.string(), ": holds no table (*.binary or *.binary.gz)"});

  material_set materials;
  for (std::size_t m = 0; m < files.size(); ++m) {
    report(listener, "reading " + files[m].name, static_cast<double>(m) / static_cast<double>(files.size()));
    const brdf_table table =
        m == 0 ? read_merl_any(files[m].path) : read_merl_any(files[m].path, {{}, materials.cells});
    if (m == 0) {
      materials.cells = table.cells();
      materials.values.resize(table.cells().size(), (3 * files.size()));
    } else if (!(table.cells() == materials.cells)) {
      gonio::refuse({files[m].path.string(), ": its valid cells differ from those of ", files[0].path.string()});
    }
    materials.names.push_back(files[m].name);
    materials.values.middleCols(3 * m, 3) =
        Eigen::Map<const cell_matrix>(table.values().data(), materials.values.rows(), 3);
  }
  return materials;
}

}  // namespace gonio::io
