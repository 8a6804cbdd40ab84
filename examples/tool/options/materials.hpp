#pragma once
/// Sources of many materials.

#include "command.hpp"
#include "team.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/io/materials/scratch_materials.hpp>
#include <gonio/table/material_set.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cli {

/// Any number of files of networks and folders of MERL tables and RGL materials; or else the materials of a prior.
struct material_source {
  std::vector<std::filesystem::path> networks, tables, rgl;
  std::filesystem::path prior;
  std::vector<std::string> exclude;
  bool as_spectra = false;       ///< reflectance at the wavelengths of RGL materials that have spectra; else colours
  std::string wavelengths = {};  ///< as 400:10:700, nanometres; empty: the materials' own
  std::optional<gonio::log_relative_pca> held_prior = {};  ///< a prior in memory, instead of the file

  [[nodiscard]] bool is_prior() const { return networks.empty() && tables.empty() && rgl.empty(); }
};

/// Returns the prior in memory, or else that of the file.
[[nodiscard]] gonio::log_relative_pca prior_of(const material_source& source);

/// Adds `--networks`, `--merl`, `--rgl` and `--exclude`. Returns the group of the first three.
option_group add_material_options(command& to, material_source& source);

/// Reads the materials of all sources. Excluded ones are not read; throws gonio::error for a name that does not exist
/// or that two materials have. From a prior all materials are returned, for a basis to leave out.
///
/// A single folder of MERL tables keeps its own cells. Otherwise all materials are over MERL's grid with values at the
/// cells' centres; tables of another convention are interpolated, RGL materials are evaluated there.
[[nodiscard]] gonio::material_set read_materials(const material_source& source, gonio::thread_count threads,
                                                 const gonio::progress& listener = {});

/// The same, but reads each material once, one after the other, into a scratch file. Not for a prior. With `cells` all
/// are over these cells: tables are interpolated, or copied if the nodes coincide; otherwise over the cells of
/// read_materials. Spectra are at the requested wavelengths, or else must all have the same. Several processes each
/// tabulate some of the materials and exchange the rows of their groups; each process reads a single MERL folder.
[[nodiscard]] gonio::material_rows stream_materials(const material_source& source,
                                                    const std::optional<gonio::valid_cells>& cells,
                                                    gonio::io::scratch_materials scratch, gonio::thread_count threads,
                                                    const gonio::progress& listener = {},
                                                    const team& processes = team());

}  // namespace cli
