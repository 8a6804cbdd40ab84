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
  bool as_spectra = false;       ///< read the spectra of RGL materials, which must have some, instead of colours
  std::string wavelengths = {};  ///< as 400:10:700, nanometres; empty: the materials' own
  std::optional<gonio::log_relative_pca> held_prior = {};  ///< a prior in memory, instead of the file

  [[nodiscard]] bool is_prior() const { return networks.empty() && tables.empty() && rgl.empty(); }
};

/// Returns the prior in memory, or else that of the file.
[[nodiscard]] gonio::log_relative_pca prior_of(const material_source& source);

/// Adds `--networks`, `--merl`, `--rgl` and `--exclude`. Returns the group of the first three.
option_group add_material_options(command& to, material_source& source);

/// Reads the materials of all sources but the excluded ones. Throws gonio::error if no material has an excluded name,
/// or if two materials have the same name. Of a prior, returns all materials, also excluded ones; the basis leaves
/// these out.
///
/// A single folder of MERL tables keeps its own cells. Otherwise all materials are over MERL's grid with values at the
/// cells' centres: tables of another convention are interpolated, RGL materials are evaluated.
[[nodiscard]] gonio::material_set read_materials(const material_source& source, gonio::thread_count threads,
                                                 const gonio::progress& listener = {});

/// Like `read_materials`, but reads one material after the other into a scratch file. Not for a prior. With `cells`,
/// all materials are over these cells: tables are interpolated, or copied if the nodes coincide. Spectra are at the
/// requested wavelengths; without a request, all must have the same wavelengths. Several processes each tabulate some
/// of the materials and exchange rows; but each process reads the whole of a single MERL folder.
[[nodiscard]] gonio::material_rows stream_materials(const material_source& source,
                                                    const std::optional<gonio::valid_cells>& cells,
                                                    gonio::io::scratch_materials scratch, gonio::thread_count threads,
                                                    const gonio::progress& listener = {},
                                                    const team& processes = team());

}  // namespace cli
