#pragma once
/// The experiments of `gonio evaluate`, one file each.

#include "inputs.hpp"
#include <gonio/evaluate/few_samples.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace cli {

void add_nielsen_test_materials(CLI::App& evaluate);
void add_measured_materials(CLI::App& evaluate);
void add_linear_combination(CLI::App& evaluate);
void add_noell_tables(CLI::App& evaluate);
void add_noell_measured(CLI::App& evaluate);
void add_noell_corrections(CLI::App& evaluate);
void add_directions(CLI::App& evaluate);
void add_directions_measured(CLI::App& evaluate);
void add_figures(CLI::App& evaluate);
void add_soft_specular(CLI::App& evaluate);
void add_eta(CLI::App& evaluate);
void add_models(CLI::App& evaluate);
void add_model_properties(CLI::App& evaluate);
void add_model_recovery(CLI::App& evaluate);
void add_laboratory(CLI::App& evaluate);
void add_importance_sampling(CLI::App& evaluate);

/// Adds `--networks FILE`, which must be given.
inline void add_networks_option(CLI::App& command, std::filesystem::path& networks) {
  command.add_option("--networks", networks, "File of networks of the 100 materials (.npy)")->required();
}

/// A file of networks, and the cells of MERL's grid that its materials are tabulated over.
struct studied_networks {
  std::filesystem::path file;
  thinning thin = {};

  [[nodiscard]] gonio::named_networks read() const { return gonio::io::read_networks(file); }
  [[nodiscard]] gonio::valid_cells cells() const { return thin.of(gonio::valid_cells()); }
};

/// Adds `--networks FILE`, which must be given, and `--thin N M`.
inline void add_networks_option(CLI::App& command, studied_networks& networks) {
  add_networks_option(command, networks.file);
  add_thin_option(command, networks.thin);
}

/// Adds `-n,--counts N ...`.
inline void add_counts_option(CLI::App& command, std::vector<std::size_t>& counts) {
  command.add_option("-n,--counts", counts, "Numbers of measurements")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

/// What a row of a table says of one figure of many reconstructions, of which there is at least one.
struct distribution {
  double mean = 0.0, median = 0.0, worst = 0.0;

  explicit distribution(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    median = (sorted[sorted.size() / 2] + sorted[(sorted.size() - 1) / 2]) / 2.0;
    worst = sorted.back();
  }
};

/// The means over materials of all measures, with the keys of `gonio compare --json`.
[[nodiscard]] inline json mean_errors(std::span<const gonio::material_result> results) {
  using gonio::mean_over;
  return {{"mapped_rms", mean_over(results, [](const auto& e) { return e.mapped_rms.mean(); })},
          {"cosine_rms", mean_over(results, [](const auto& e) { return e.cosine_rms.mean(); })},
          {"delta_e_lights", mean_over(results, [](const auto& e) { return e.delta_e_lights; })},
          {"delta_e_env", mean_over(results, [](const auto& e) { return e.delta_e_env; })},
          {"peak_ratio", mean_over(results, [](const auto& e) { return e.peak_ratio.mean(); })}};
}

/// The errors of each material by its name.
[[nodiscard]] inline json errors_by_name(std::span<const gonio::material_result> results) {
  json materials = json::object();
  for (const auto& [name, errors] : results) materials[name] = to_json(errors);
  return materials;
}

}  // namespace cli
