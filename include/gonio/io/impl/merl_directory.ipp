#pragma once
/// Bodies of io/merl_directory.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/io/merl_directory.hpp>
#include <gonio/io/merl_gzip.hpp>
#include <gonio/table/material_set.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace gonio::io {

GONIO_INLINE std::vector<named_file> list_merl_directory(const std::filesystem::path& folder) {
  static constexpr std::array<std::string_view, 2> extensions{".binary", ".binary.gz"};
  return list_named_files(folder, extensions, "table");
}

GONIO_INLINE material_set read_merl_directory(const std::filesystem::path& folder,
                                              const std::vector<std::string>& excluded, const progress& listener) {
  std::vector<named_file> files = list_merl_directory(folder);
  for (const std::string& name : excluded)
    if (std::erase_if(files, [&](const named_file& file) { return file.name == name; }) == 0)
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
