#pragma once
/// Where many materials come from.

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

/// Files of networks, folders of MERL tables and folders of RGL materials, any number of each; or else the materials
/// that a prior remembers.
struct material_source {
  std::vector<std::filesystem::path> networks, tables, rgl;
  std::filesystem::path prior;
  std::vector<std::string> exclude;
  bool as_spectra = false;       ///< reflectance at wavelengths, of RGL materials that have it; else colours
  std::string wavelengths = {};  ///< as 400:10:700, nanometres; those of the materials if it is empty
  std::optional<gonio::log_relative_pca> held_prior = {};  ///< one in memory, instead of the file

  [[nodiscard]] bool is_prior() const { return networks.empty() && tables.empty() && rgl.empty(); }
};

/// The prior that is held, or else that of the file.
[[nodiscard]] gonio::log_relative_pca prior_of(const material_source& source);

/// Adds `--networks`, `--merl`, `--rgl` and `--exclude`. Returns the first three.
option_group add_material_options(command& to, material_source& source);

/// The materials of all sources together. Those that are excluded are not read, and a name that does not exist, or that
/// two materials have, throws gonio::error; of a prior all materials come, for a basis to leave out.
///
/// A single folder of MERL tables keeps its own cells. Otherwise all materials are over MERL's grid with values at the
/// cells' centres, tables of another convention interpolated, RGL materials evaluated there.
[[nodiscard]] gonio::material_set read_materials(const material_source& source, gonio::thread_count threads,
                                                 const gonio::progress& listener = {});

/// The same, each read once, one after the other, and held by a scratch file. With `cells` all are over these: tables
/// are interpolated, or copied where the cells' nodes coincide. Without, they are where read_materials has them. Not of
/// a prior. All spectra are at the wavelengths that are asked for, or else must be at the same ones. Several processes
/// each tabulate some of the materials, and hand one another the rows of their groups; a single folder of MERL tables
/// each reads by itself.
[[nodiscard]] gonio::material_rows stream_materials(const material_source& source,
                                                    const std::optional<gonio::valid_cells>& cells,
                                                    gonio::io::scratch_materials scratch, gonio::thread_count threads,
                                                    const gonio::progress& listener = {},
                                                    const team& processes = team());

}  // namespace cli
