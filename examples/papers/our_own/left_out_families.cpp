#include "left_out_families.hpp"

#include "papers/our_own/random_materials.hpp"
#include "tool/options/threads_option.hpp"
#include <gonio/basis/learn_pca.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/io/materials/rgl.hpp>

#include <random>

namespace papers {

namespace {

/// Appends a table to a set whose values have columns for it.
void append(gonio::material_set& set, std::string name, const gonio::brdf_table& table) {
  set.values.middleCols(3 * std::ssize(set.names), 3) =
      Eigen::Map<const gonio::cell_matrix>(table.values().data(), set.values.rows(), 3);
  set.names.push_back(std::move(name));
}

}  // namespace

material_library::material_library(const std::vector<std::filesystem::path>& networks,
                                   const std::filesystem::path& measured, const cli::thinning& thin,
                                   const gonio::progress& listener, gonio::thread_count threads)
    : cells_(thin.of(gonio::valid_cells())), threads_(threads) {
  for (const std::filesystem::path& file : networks)
    sets_.push_back(gonio::model::tabulate_networks(gonio::io::read_networks(file), cells_, threads, listener));
  gonio::material_set set{cells_, {}, {}};
  const auto files = gonio::io::list_rgl_directory(measured);
  if (files.empty()) gonio::refuse(measured.string() + ": holds no material (*.bsdf)");
  set.values.resize(static_cast<Eigen::Index>(cells_.size()), 3 * std::ssize(files));
  for (const auto& [name, path] : files)
    append(set, name, gonio::tabulate(gonio::io::read_rgl(path).material, cells_, threads));
  sets_.push_back(std::move(set));
}

gonio::log_relative_pca material_library::prior_without(const std::string& family, Eigen::Index components,
                                                        Eigen::Index random_materials) const {
  auto set = materials(all(), [&](const std::string& name) { return gonio::material_family(name) != family; });
  set.values.conservativeResize(Eigen::NoChange, set.values.cols() + 3 * random_materials);
  for (Eigen::Index i = 0; i < random_materials; ++i)
    append(set, "random-" + std::to_string(i), random_material(static_cast<std::uint64_t>(i), cells_, threads_));
  const auto metric = gonio::log_relative::to_median_of(set, threads_);
  return gonio::learn_pca(std::move(set), metric, components, threads_);
}

void add_left_out_options(cli::command& to, left_out_options& options) {
  to.add_input("--networks", options.networks, "Files of networks (.npy): surrogates to learn from").required();
  to.add_input_folder("--materials", options.materials, {".bsdf"}, "Folder of measured materials (.bsdf)").required();
  to.add_option("--components", options.components, "Number of components of the priors of all materials")
      .check(cli::check::positive_number())
      .capture_default_str();
  cli::add_thin_option(to, options.thin);
  add_resumable_options(to, options);
}

left_out_experiment::left_out_experiment(const left_out_options& given, cli::progress_bar& bar)
    : bar_(bar),
      threads_(given.threads),
      library_(given.networks, given.materials, given.thin, bar.listener(), given.threads),
      judge_(library_.cells(), 36, given.threads),
      metric_(gonio::log_relative::to_median_of(library_.first(), given.threads)),
      results_(given) {}

std::vector<judged_material> measured_materials(const std::filesystem::path& folder, const material_library& library) {
  std::vector<judged_material> all;
  const gonio::material_set& set = library.measured();
  for (const auto& [name, path] : gonio::io::list_rgl_directory(folder)) {
    auto measured = [f = gonio::io::read_rgl(path).material](const gonio::direction_pair& pair) {
      return f(pair.wi, pair.wo);
    };
    const std::string family = gonio::material_family(name);
    const std::size_t turn = all.empty() ? 0 : all.back().turn + (all.back().family == family ? 0 : 1);
    all.push_back({name, family, set.table(set.find(name)), std::move(measured), all.size(), turn});
  }
  return all;
}

sampling random_sampling(Eigen::Index count, Eigen::Index repetitions) {
  const gonio::valid_cells cells;
  sampling drawn{std::to_string(count) + " random", {}};
  for (Eigen::Index r = 0; r < repetitions; ++r) {
    std::vector<gonio::half_difference> directions;
    for (const Eigen::Index cell : gonio::random_cells(cells, count, r)) directions.push_back(cells.angles(cell));
    drawn.sets.push_back(std::move(directions));
  }
  return drawn;
}

gonio::sample_set measure(const reflectance& of, const std::vector<gonio::half_difference>& directions, double noise,
                          std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  gonio::sample_set samples;
  for (const gonio::half_difference& angles : directions) {
    gonio::rgb value = of(gonio::to_directions(angles));
    for (Eigen::Index c = 0; c < 3; ++c) value[c] *= 1.0 + noise * normal(random);
    samples.push_back({angles, value, 1.0});
  }
  return samples;
}

gonio::sample_set of_mean_material(const gonio::sample_set& samples, const gonio::log_relative_pca& prior) {
  gonio::sample_set mean;
  for (const gonio::sample& s : samples) {
    const gonio::location at = gonio::locate(prior.cells(), s.angles());
    const double value = prior.metric().inverse(gonio::offset_at(prior, at), at);
    mean.push_back({s.angles(), gonio::rgb::Constant(std::max(value, 0.0)), 1.0});
  }
  return mean;
}

}  // namespace papers
