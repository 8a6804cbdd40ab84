#pragma once
/// Where many materials come from.

#include "command.hpp"
#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/table/material_set.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace cli {

/// Networks, MERL tables, or else the materials that a prior remembers.
struct material_source {
  std::filesystem::path networks, tables, prior;
  std::vector<std::string> exclude;

  [[nodiscard]] bool is_prior() const { return networks.empty() && tables.empty(); }
};

/// Adds `--networks`, `--merl` and `--exclude`. Returns the first two, of which at most one may be given.
option_group add_material_options(command& to, material_source& source);

/// The materials of a source. Networks and tables that are excluded are not read, and a name that does not exist throws
/// gonio::error; of a prior all materials come, for a basis to leave out.
[[nodiscard]] gonio::material_set read_materials(const material_source& source, gonio::thread_count threads,
                                                 const gonio::progress& listener = {});

}  // namespace cli
