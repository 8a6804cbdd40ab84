/// gonio-papers measured-materials: tables of another database, reconstructed from random samples.

#include "papers/experiments.hpp"
#include "papers/material_result.hpp"
#include "papers/mean_errors.hpp"
#include "tool/files/json.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/contact_sheet.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl_directory.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/render/exposure.hpp>
#include <gonio/render/horizon_lookup.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/sphere.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <iostream>
#include <memory>

namespace papers {

namespace {

struct measured_options {
  std::filesystem::path tables, prior, image;
  std::vector<Eigen::Index> counts{20, 500};
  double eta = 40.0;
  std::uint64_t seed = 1;
  Eigen::Index repetitions = 5;
  bool print_json = false;
  gonio::thread_count threads;
};

/// Enough samples for a lower bound on the prior's error: a fit to a random tenth of the cells.
constexpr Eigen::Index many_samples = 100'000;

gonio::brdf_table reconstruct(const measured_options& options, const gonio::log_relative_pca& prior,
                              const gonio::brdf_table& truth, std::size_t count, std::uint64_t seed) {
  const auto samples = gonio::sample_table(truth, gonio::random_cells(truth.cells(), count, seed));
  return gonio::decomposition{prior, gonio::tikhonov{options.eta}}.fit(samples).tabulate(truth.cells(),
                                                                                         options.threads);
}

/// Errors of one table for each number of samples (all repetitions), and its row of spheres.
struct table_report {
  std::vector<std::vector<material_result>> errors;
  std::vector<gonio::image> spheres;
};

table_report judge_table(const measured_options& options, const gonio::log_relative_pca& prior, const std::string& name,
                         const gonio::brdf_table& truth, const gonio::appearance_metric& appearance) {
  table_report result;
  const auto draw = [&](const gonio::brdf_table& table) {
    if (!options.image.empty())
      result.spheres.push_back(gonio::render::render_sphere(gonio::render::horizon_lookup(table),
                                                            gonio::render::two_lights(),
                                                            {.size = 128, .supersampling = 2}, options.threads));
  };
  for (const Eigen::Index count : options.counts) {
    auto& repetitions = result.errors.emplace_back();
    const Eigen::Index times = count >= many_samples ? 1 : options.repetitions;
    for (Eigen::Index r = 0; r < times; ++r) {
      const auto estimate = reconstruct(options, prior, truth, count, options.seed + r);
      repetitions.push_back({name, gonio::compare(estimate, truth, prior.metric(), appearance, options.threads)});
      if (r == 0) draw(estimate);
    }
  }
  draw(truth);
  if (!result.spheres.empty()) {
    const double exposure = gonio::render::exposure_of_spheres(std::span(result.spheres).last(1));
    for (gonio::image& sphere : result.spheres) gonio::render::expose(sphere, exposure);
  }
  return result;
}

void run(const measured_options& options) {
  progress_bar bar;
  // Read the prior, and list the tables.
  const auto prior = gonio::io::read_prior(options.prior);
  const auto files = gonio::io::list_merl_directory(options.tables);
  // Reconstruct each table from random samples, and compare the results with it.
  std::vector<gonio::image> all_spheres;
  sheet_text text;
  std::vector<gonio::appearance_metric>
      appearances;  // on the cells of the last table, which the next table often shares
  json result = json::object();
  for (std::size_t f = 0; f < files.size(); ++f) {
    bar.draw(files[f].name, static_cast<double>(f) / static_cast<double>(files.size()));
    const auto truth = gonio::io::read_merl_any(files[f].path);
    if (appearances.empty() || !(appearances.back().cells() == truth.cells()))
      appearances.assign(1, gonio::appearance_metric(truth.cells(), 36, options.threads));
    const auto [errors, spheres] = judge_table(options, prior, files[f].name, truth, appearances.back());
    for (std::size_t i = 0; i < options.counts.size(); ++i) {
      json means = mean_errors(errors[i]);
      means["peak_ratio"] = mean_over(errors[i], [](const auto& e) { return e.peak_ratio.mean(); });
      result[files[f].name][std::to_string(options.counts[i])] = means;
    }
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      all_spheres.push_back(spheres[i]);
      text.labels.push_back(i < options.counts.size() ? std::to_string(options.counts[i]) + " samples" : files[f].name);
    }
  }
  bar.wipe();
  if (!options.image.empty())
    gonio::io::write_png(options.image, contact_sheet(all_spheres, options.counts.size() + 1, text));

  // Print the errors.
  if (options.print_json) {
    std::cout << result.dump(2) << '\n';
    return;
  }
  std::cout << "Means over " << options.repetitions << " sets of random samples, eta = " << options.eta << ".\n\n"
            << "| material | samples | mapped rms | cosine rms | Delta E env | Delta E lights | peak ratio "
               "|\n|---|---|---|---|---|---|---|\n";
  for (const auto& [name, counts] : result.items())
    for (const auto& [count, means] : counts.items())
      std::cout << "| " << name << " | " << count << " | " << fixed(means["mapped_rms"], 3) << " | "
                << fixed(means["cosine_rms"], 3) << " | " << fixed(means["delta_e_env"], 2) << " | "
                << fixed(means["delta_e_lights"], 2) << " | " << fixed(means["peak_ratio"], 2) << " |\n";
}

}  // namespace

void add_measured_materials(command& app) {
  auto command =
      app.add_subcommand("measured-materials", "Reconstruct each table of a folder from random samples of it");
  const auto options = std::make_shared<measured_options>();
  command
      .add_input_folder("--tables", options->tables, {".binary", ".gz"},
                        "Folder of MERL tables (.binary or .binary.gz)")
      .required();
  add_prior_option(command, options->prior);
  command.add_option("--counts", options->counts, "Numbers of samples")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--eta", options->eta, "Tikhonov's penalty").capture_default_str();
  command.add_option("--seed", options->seed, "Seed of the first set of samples").capture_default_str();
  command.add_option("--repetitions", options->repetitions, "Number of sets of samples for each count")
      .check(check::positive_number())
      .capture_default_str();
  command.add_output("--spheres", options->image, {".png"},
                     "Image to write (.png): a row for each table, the truth at the right");
  command.add_flag("--json", options->print_json, "Print as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace papers
