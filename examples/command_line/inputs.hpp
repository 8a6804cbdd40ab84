#pragma once
/// What several subcommands read and print.

#include <gonio/core/progress.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/io/merl_gzip.hpp>
#include <gonio/io/networks.hpp>
#include <gonio/io/prior.hpp>
#include <gonio/table/sample_set.hpp>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace cli {

using json = nlohmann::ordered_json;

/// The prior that ships with the tool: installed beside it, or in the source tree it was built from.
[[nodiscard]] std::filesystem::path shipped_prior();

/// Adds `--prior FILE` with the shipped prior as the default.
void add_prior_option(CLI::App& command, std::filesystem::path& prior);

/// Where many materials come from: networks, MERL tables, or else the materials that a prior remembers.
struct material_source {
  std::filesystem::path networks, tables, prior;
  std::vector<std::string> exclude;

  [[nodiscard]] bool is_prior() const { return networks.empty() && tables.empty(); }
};

/// Adds `--networks`, `--merl` and `--exclude`. Returns the first two, of which at most one may be given.
CLI::Option_group* add_material_options(CLI::App& command, material_source& source);

/// The materials of a source. Networks and tables that are excluded are not read, and a name that does not exist throws
/// gonio::error; of a prior all materials come, for a basis to leave out.
[[nodiscard]] gonio::material_set read_materials(const material_source& source, gonio::thread_count threads,
                                                 const gonio::progress& listener = {});

/// Which cells of a grid are kept: every n-th theta_d and every m-th phi_d.
struct thinning {
  int theta_d = 1, phi_d = 1;

  /// Throws gonio::error if the numbers do not divide those of the grid. An odd step of cell centres is a grid of cell
  /// centres again.
  [[nodiscard]] gonio::valid_cells of(const gonio::valid_cells& cells) const;
};

/// Adds `--thin N M`.
void add_thin_option(CLI::App& command, thinning& thin);

/// Measurements: samples as CSV, or if the name ends in .brdf, Cornell's text format.
[[nodiscard]] gonio::sample_set read_measurements(const std::filesystem::path& path);

/// Writes a table in the format that the name asks for: an array if it ends in .npy, otherwise MERL's.
void write_table(const std::filesystem::path& path, const gonio::brdf_table& table);

/// Adds `--threads N`.
void add_threads_option(CLI::App& command, gonio::thread_count& threads);

/// Three numbers as an array.
[[nodiscard]] json per_channel(const gonio::rgb& values);

/// The keys that `gonio compare --json` documents.
[[nodiscard]] json to_json(const gonio::comparison& errors);

/// A number in a table for people.
[[nodiscard]] std::string fixed(double value, int digits);

/// The networks whose names are (or are not) in a list. Throws gonio::error if a listed name does not exist.
[[nodiscard]] gonio::named_networks networks_in(const gonio::named_networks& all,
                                                const std::vector<std::string>& names);
[[nodiscard]] gonio::named_networks networks_except(const gonio::named_networks& all,
                                                    const std::vector<std::string>& names);

}  // namespace cli
