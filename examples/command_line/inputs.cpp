#include "inputs.hpp"

#include <gonio/basis/expand_materials.hpp>
#include <gonio/io/cornell.hpp>
#include <gonio/io/merl_directory.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/io/table_npy.hpp>

#include <algorithm>
#include <cstdio>

namespace cli {

std::filesystem::path shipped_prior() {
  std::error_code ignored;
  const auto tool = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const auto installed = tool.parent_path().parent_path() / "share/gonio/materials.prior";
  return std::filesystem::exists(installed, ignored) ? installed : std::filesystem::path(GONIO_SOURCE_PRIOR);
}

void add_prior_option(CLI::App& command, std::filesystem::path& prior) {
  prior = shipped_prior();
  command.add_option("--prior", prior, "The learned prior (default: the one shipped with gonio)");
}

CLI::Option_group* add_material_options(CLI::App& command, material_source& source) {
  auto* group = command.add_option_group("source", "Where the materials come from (one of)");
  group->add_option("--networks", source.networks, "File of networks (.npy, names in merl_names.txt beside it)");
  group->add_option("--merl", source.tables, "Folder of MERL tables (.binary or .binary.gz)");
  group->require_option(0, 1);
  command.add_option("--exclude", source.exclude, "Name of a material to leave out (repeatable)")
      ->expected(1)
      ->take_all();
  return group;
}

gonio::material_set read_materials(const material_source& source, gonio::thread_count threads,
                                   const gonio::progress& listener) {
  if (!source.tables.empty()) return gonio::io::read_merl_directory(source.tables, source.exclude, listener);
  if (source.networks.empty()) return gonio::expand(gonio::io::read_prior(source.prior), threads);
  const auto chosen = networks_except(gonio::io::read_networks(source.networks), source.exclude);
  return gonio::tabulate_networks(chosen, gonio::valid_cells(), threads, listener);
}

gonio::valid_cells thinning::of(const gonio::valid_cells& cells) const {
  const gonio::grid_extents extents = cells.grid().extents();
  if (extents.theta_d % theta_d != 0 || extents.phi_d % phi_d != 0)
    throw gonio::error("--thin " + std::to_string(theta_d) + " " + std::to_string(phi_d) +
                       " does not divide the table's " + std::to_string(extents.theta_d) + " and " +
                       std::to_string(extents.phi_d) + " cells");
  const gonio::grid kept({extents.theta_h, extents.theta_d / theta_d, extents.phi_d / phi_d}, cells.grid().anchor());
  return gonio::valid_cells(kept, cells.minimum_cosine());
}

void add_thin_option(CLI::App& command, thinning& thin) {
  const auto default_value = std::to_string(thin.theta_d) + ' ' + std::to_string(thin.phi_d);
  command
      .add_option_function<std::pair<int, int>>(
          "--thin",
          [&thin](const auto& steps) {
            thin = {steps.first, steps.second};
          },
          "Keep every n-th theta_d and every m-th phi_d; 1 1 keeps all")
      ->check(CLI::Range(1, 90))
      ->default_str(default_value);
}

gonio::sample_set read_measurements(const std::filesystem::path& path) {
  return path.extension() == ".brdf" ? gonio::io::read_cornell(path) : gonio::io::read_samples(path);
}

void write_table(const std::filesystem::path& path, const gonio::brdf_table& table) {
  if (path.extension() == ".npy")
    gonio::io::write_table_npy(path, table);
  else
    gonio::io::write_merl(path, table);
}

void add_threads_option(CLI::App& command, gonio::thread_count& threads) {
  command.add_option("--threads", threads.value, "Number of threads (default: one per core)")
      ->check(CLI::Range(1u, 1024u));
}

json per_channel(const gonio::rgb& values) { return json::array({values.x(), values.y(), values.z()}); }

json to_json(const gonio::comparison& errors) {
  return {{"mapped_rms", errors.mapped_rms.mean()},
          {"cosine_rms", errors.cosine_rms.mean()},
          {"delta_e_lights", errors.delta_e_lights},
          {"delta_e_env", errors.delta_e_env},
          {"peak_ratio", errors.peak_ratio.mean()},
          {"channels",
           {{"mapped_rms", per_channel(errors.mapped_rms)},
            {"cosine_rms", per_channel(errors.cosine_rms)},
            {"peak_ratio", per_channel(errors.peak_ratio)}}}};
}

std::string fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

namespace {

gonio::named_networks select(const gonio::named_networks& all, const std::vector<std::string>& names, bool wanted) {
  for (const std::string& name : names)
    if (std::ranges::find(all.names, name) == all.names.end())
      throw gonio::error("there is no material named '" + name + "' among the " + std::to_string(all.names.size()) +
                         " networks");
  gonio::named_networks chosen;
  for (std::size_t i = 0; i < all.names.size(); ++i) {
    const bool listed = std::ranges::find(names, all.names[i]) != names.end();
    if (listed != wanted) continue;
    chosen.names.push_back(all.names[i]);
    chosen.networks.push_back(all.networks[i]);
  }
  return chosen;
}

}  // namespace

gonio::named_networks networks_in(const gonio::named_networks& all, const std::vector<std::string>& names) {
  return select(all, names, true);
}

gonio::named_networks networks_except(const gonio::named_networks& all, const std::vector<std::string>& names) {
  return select(all, names, false);
}

}  // namespace cli
