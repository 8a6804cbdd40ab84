/// gonio-papers importance-sampling: how much the variance of light estimates falls if directions are drawn by
/// importance of the BRDF rather than cosine-weighted.

#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "tool/files/json.hpp"
#include "tool/options/chosen_networks.hpp"
#include "tool/options/thinning.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/core/random.hpp>
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/render/environment_sampler.hpp>
#include <gonio/render/half_vector_sampler.hpp>
#include <gonio/render/lookup_table.hpp>

#include <iostream>
#include <memory>
#include <random>

namespace papers {

namespace {

struct sampling_options {
  studied_networks networks;
  std::vector<std::filesystem::path> environments, tables;
  Eigen::Index points = 10'000, draws = 200;
  std::uint64_t seed = 1;
  bool print_json = false;
  gonio::thread_count threads;
};

struct named_light {
  std::string name;
  gonio::render::environment_sampler light;
};

using sampled_material = gonio::render::half_vector_sampler<gonio::render::lookup_table<>>;

std::vector<named_light> lights_of(const sampling_options& options) {
  std::vector<named_light> lights;
  lights.push_back({"white", gonio::render::environment_sampler(gonio::render::environment_map::of(
                                 [](const gonio::direction&) { return gonio::rgb(gonio::rgb::Ones()); }, 64))});
  lights.push_back({"formula", gonio::render::environment_sampler(
                                   gonio::render::environment_map::of(gonio::render::formula_environment{}))});
  for (const auto& path : options.environments)
    lights.push_back({path.stem().string(),
                      gonio::render::environment_sampler(gonio::render::environment_map(gonio::io::read_hdr(path)))});
  return lights;
}

/// Variances of one-sample estimates of the luminance towards the camera.
struct variances {
  double by_cosine = 0.0, by_importance = 0.0;
};

/// Returns the variances at a point of the sphere. The variance of f L cos / pdf is the integral of its square times
/// pdf, minus its squared mean. The environment draws half of the directions and the material the other half; both
/// variances use the same directions. Without the environment's directions, the material's directions could miss a
/// small lamp, and chance would dominate the table.
variances variances_at(const gonio::render::surface_frame& surface, const sampled_material& f,
                       const gonio::render::environment_sampler& light, std::size_t draws, std::mt19937_64& generator) {
  const auto number = [&] { return gonio::uniform_number(generator); };
  const gonio::direction wo = surface.to_local(gonio::direction::UnitZ());
  variances squares;
  double mean = 0.0;
  for (std::size_t i = 0; i < draws; ++i) {
    const double u1 = number(), u2 = number();
    const gonio::direction wi = i % 2 == 0 ? surface.to_local(light.sample(u1, u2).towards) : f.sample(wo, u1, u2).wi;
    if (!(wi.z() > 0.0)) continue;
    const gonio::direction towards = surface.to_world(wi);
    const double importance = f.pdf(wi, wo), drawn = 0.5 * (light.pdf(towards) + importance);
    const double value = gonio::luminance(f.brdf()(wi, wo) * light.map()(towards)) * wi.z();
    const double share = 1.0 / (drawn * static_cast<double>(draws));
    mean += value * share;
    squares.by_cosine += value * value / gonio::cosine_weighted_pdf(wi) * share;
    squares.by_importance += value * value / importance * share;
  }
  return {squares.by_cosine - mean * mean, squares.by_importance - mean * mean};
}

/// Returns the ratio of the mean variances over the visible points of a sphere.
double ratio_of_variances(const sampled_material& f, const gonio::render::environment_sampler& light,
                          const sampling_options& options) {
  std::mt19937_64 generator(options.seed);
  const auto number = [&] { return gonio::uniform_number(generator); };
  variances sum;
  for (Eigen::Index point = 0; point < options.points; ++point) {
    const double within = number(), turn = 2.0 * std::numbers::pi * number();
    const double squared = (static_cast<double>(point) + within) / static_cast<double>(options.points);
    const double radius = std::sqrt(squared);
    const gonio::render::surface_frame surface(
        {radius * std::cos(turn), radius * std::sin(turn), std::sqrt(1.0 - squared)});
    const variances at = variances_at(surface, f, light, options.draws, generator);
    sum.by_cosine += at.by_cosine;
    sum.by_importance += at.by_importance;
  }
  return sum.by_cosine / sum.by_importance;
}

struct named_table {
  std::string name;
  gonio::brdf_table table;
};

std::vector<named_table> tables_of(const sampling_options& options) {
  std::vector<named_table> tables;
  if (!options.networks.file.empty()) {
    const auto networks = networks_in(options.networks.read(), gonio::nielsen_test_materials(), options.networks.file);
    const auto cells = options.networks.cells();
    for (std::size_t i = 0; i < networks.names.size(); ++i)
      tables.push_back({networks.names[i], gonio::tabulate(networks.networks[i], cells, options.threads)});
  }
  for (const auto& path : options.tables) tables.push_back({path.stem().string(), gonio::io::read_merl_any(path)});
  if (tables.empty()) gonio::refuse("no materials: give --networks or tables");
  return tables;
}

void run_sampling(const sampling_options& options) {
  progress_bar bar;
  // Compare the variances of each material under each light.
  const auto lights = lights_of(options);
  const auto tables = tables_of(options);
  std::vector<std::vector<double>> ratios(tables.size(), std::vector<double>(lights.size()));
  std::mutex reporting;
  Eigen::Index done = 0;
  gonio::for_each_block(
      tables.size(), 1,
      [&](gonio::block range) {
        const sampled_material sampler(gonio::render::lookup_table<>::of(tables[range.begin].table));
        for (std::size_t i = 0; i < lights.size(); ++i)
          ratios[range.begin][i] = ratio_of_variances(sampler, lights[i].light, options);
        const std::scoped_lock lock(reporting);
        gonio::report(bar.listener(), "materials", static_cast<double>(++done) / static_cast<double>(tables.size()));
      },
      options.threads);
  bar.wipe();

  // Print the ratios.
  if (options.print_json) {
    json all;
    for (std::size_t i = 0; i < tables.size(); ++i)
      for (std::size_t k = 0; k < lights.size(); ++k) all[tables[i].name][lights[k].name] = ratios[i][k];
    std::cout << all.dump(2) << '\n';
    return;
  }
  std::cout << "Variance with cosine-weighted directions over that by importance of the BRDF, means over a sphere.\n\n"
            << "| material |";
  for (const auto& [name, light] : lights) std::cout << ' ' << name << " |";
  std::cout << "\n|---|";
  for (std::size_t k = 0; k < lights.size(); ++k) std::cout << "---|";
  for (std::size_t i = 0; i < tables.size(); ++i) {
    std::cout << "\n| " << tables[i].name << " |";
    for (const double ratio : ratios[i])
      std::cout << ' ' << fixed(ratio, ratio < 10.0 ? 2 : ratio < 100.0 ? 1 : 0) << " |";
  }
  std::cout << '\n';
}

}  // namespace

void add_importance_sampling(command& app) {
  auto command = app.add_subcommand(
      "importance-sampling", "How much less estimates of light vary with directions drawn by importance of the BRDF");
  const auto options = std::make_shared<sampling_options>();
  command.add_input("tables", options->tables, "Tables of materials (.binary or .binary.gz)");
  command.add_input("--networks", options->networks.file,
                    "File of networks of the 100 materials (.npy), of which the ten test materials are used");
  add_thin_option(command, options->networks.thin);
  command.add_input("--environment", options->environments,
                    "Environments in addition to a white sky and a formula: latitude-longitude images (.hdr)");
  command.add_option("--points", options->points, "Number of points of the sphere")
      .check(check::range(1, 1'000'000))
      .capture_default_str();
  command.add_option("--draws", options->draws, "Number of directions for each point")
      .check(check::range(2, 100'000'000))
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of points and directions").capture_default_str();
  command.add_flag("--json", options->print_json, "Print the ratios as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run_sampling(*options); });
}

}  // namespace papers
