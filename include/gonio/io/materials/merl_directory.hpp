#pragma once
/// A folder of MERL tables as one set of materials.

#include <gonio/core/progress.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/io/text/named_files.hpp>
#include <gonio/table/material_set.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gonio::io {

/// Lists the MERL tables (`.binary` or `.binary.gz`) in a folder; see `list_named_files`.
[[nodiscard]] std::vector<named_file> list_merl_directory(const std::filesystem::path& folder);

/// Reads the tables of a folder except the excluded ones, and calls `take` for each with its name, the table and the
/// total number of tables. At most two are in memory. Throws gonio::error naming the file if an excluded table does not
/// exist or if tables are over different cells.
void for_each_table(const std::filesystem::path& folder, const std::vector<std::string>& excluded,
                    const std::function<void(const std::string& name, brdf_table table, std::size_t of)>& take,
                    const progress& listener = {});

/// Reads all tables of a folder except the excluded ones. Takes 4 bytes per value; negative values are kept. Throws
/// gonio::error as `for_each_table` does.
[[nodiscard]] material_set read_merl_directory(const std::filesystem::path& folder,
                                               const std::vector<std::string>& excluded = {},
                                               const progress& listener = {});

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/merl_directory.ipp>
#endif
