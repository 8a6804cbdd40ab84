/// gonio learn: principal components of many materials, as a file.

#include "command.hpp"
#include "inputs.hpp"
#include "progress_bar.hpp"
#include <gonio/basis/learn_pca.hpp>

#include <iostream>
#include <memory>

namespace cli {

namespace {

struct learn_options {
  material_source materials;
  std::filesystem::path output;
  std::size_t components = 60;
  std::vector<int> thin{3, 5};
  gonio::thread_count threads;
};

std::string source_of(const material_source& source, std::size_t materials) {
  std::string text = std::to_string(materials) + " materials of ";
  text += source.networks.empty() ? "tables in " + source.tables.filename().string()
                                  : "networks in " + source.networks.filename().string();
  for (const std::string& name : source.exclude) text += (name == source.exclude.front() ? ", without " : ", ") + name;
  return text;
}

/// Every n-th theta_d and phi_d; an odd step of cell centres is a grid of cell centres again.
gonio::valid_cells thinned_cells(const gonio::valid_cells& cells, int theta_d, int phi_d) {
  const gonio::grid_extents extents = cells.grid().extents();
  if (extents.theta_d % theta_d != 0 || extents.phi_d % phi_d != 0)
    throw gonio::error("--thin " + std::to_string(theta_d) + " " + std::to_string(phi_d) +
                       " does not divide the table's " + std::to_string(extents.theta_d) + " and " +
                       std::to_string(extents.phi_d) + " cells");
  const gonio::grid thin({extents.theta_h, extents.theta_d / theta_d, extents.phi_d / phi_d}, cells.grid().anchor());
  return gonio::valid_cells(thin, cells.minimum_cosine());
}

}  // namespace

void add_learn(CLI::App& app) {
  auto* command = app.add_subcommand("learn", "Learn a prior (principal components) from many materials");
  const auto options = std::make_shared<learn_options>();
  add_material_options(*command, options->materials)->require_option(1);
  command->add_option("--components", options->components, "Number of components to keep")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--thin", options->thin, "Keep every n-th theta_d and every m-th phi_d; 1 1 keeps all")
      ->expected(2)
      ->check(CLI::Range(1, 90))
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "Prior to write")->required();
  add_threads_option(*command, options->threads);
  command->callback([options] {
    progress_bar bar;
    auto materials = read_materials(options->materials, options->threads, bar.listener());
    const std::string source_text = source_of(options->materials, materials.names.size());
    const auto cells = thinned_cells(materials.cells, options->thin[0], options->thin[1]);
    const auto metric = gonio::log_relative::to_median_of(materials, options->threads);
    const auto learned =
        gonio::learn_pca(std::move(materials), metric, options->components, options->threads, bar.listener());
    gonio::io::write_prior(options->output, gonio::thin(learned, cells).with_source(source_text));
    std::cout << "kept " << learned.size() << " components of " << source_text << ": "
              << fixed(100.0 * learned.explained_variance(), 2) << " % of the mapped variance\n";
  });
}

}  // namespace cli
