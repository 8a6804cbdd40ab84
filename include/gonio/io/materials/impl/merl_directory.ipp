#pragma once
/// Bodies of io/materials/merl_directory.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/io/materials/merl_directory.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/table/material_set.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

namespace gonio::io {

GONIO_INLINE std::vector<named_file> list_merl_directory(const std::filesystem::path& folder) {
  static constexpr std::array<std::string_view, 2> extensions{".binary", ".binary.gz"};
  return list_named_files(folder, extensions, "MERL table");
}

GONIO_INLINE void for_each_table(
    const std::filesystem::path& folder, const std::vector<std::string>& excluded,
    const std::function<void(const std::string& name, brdf_table table, std::size_t of)>& take,
    const progress& listener) {
  std::vector<named_file> files = list_merl_directory(folder);
  for (const std::string& name : excluded)
    if (std::erase_if(files, [&](const named_file& file) { return file.name == name; }) == 0)
      gonio::refuse({folder.string(), ": there is no table named '", name, "' to exclude"});
  if (files.empty()) gonio::refuse({folder.string(), ": all of its tables are excluded"});

  std::optional<valid_cells> cells;
  for (std::size_t m = 0; m < files.size(); ++m) {
    report(listener, "reading " + files[m].name, static_cast<double>(m) / static_cast<double>(files.size()));
    brdf_table table = read_merl_any(files[m].path, {{}, cells});
    if (!cells) cells = table.cells();
    if (!(table.cells() == *cells))
      gonio::refuse({files[m].path.string(), ": its valid cells differ from those of ", files[0].path.string()});
    take(files[m].name, std::move(table), files.size());
  }
}

GONIO_INLINE material_set read_merl_directory(const std::filesystem::path& folder,
                                              const std::vector<std::string>& excluded, const progress& listener) {
  material_set materials;
  const auto take = [&](const std::string& name, const brdf_table& table, std::size_t of) {
    if (materials.names.empty()) {
      materials.cells = table.cells();
      materials.values.resize(table.cells().size(), 3 * of);
    }
    materials.values.middleCols(3 * std::ssize(materials.names), 3) =
        Eigen::Map<const cell_matrix>(table.values().data(), materials.values.rows(), 3);
    materials.names.push_back(name);
  };
  for_each_table(folder, excluded, take, listener);
  return materials;
}

}  // namespace gonio::io
