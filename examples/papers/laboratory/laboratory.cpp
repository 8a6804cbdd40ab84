/// gonio-papers laboratory: measured tables are scanned in the simulated laboratory, calibrated and reconstructed, and
/// compared with the original tables.

#include "lab/measure.hpp"
#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/material_result.hpp"
#include "papers/mean_errors.hpp"
#include "tool/files/json.hpp"
#include "tool/options/machine_choice.hpp"
#include "tool/options/reconstruct_methods.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/core/random.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <array>
#include <iostream>
#include <memory>
#include <random>

namespace papers {

namespace {

struct laboratory_options {
  std::vector<std::filesystem::path> tables;
  std::filesystem::path directions, prior;
  machine_choice machine;
  Eigen::Index many = 2000, repetitions = 5;
  double outliers = 0.05;
  std::uint64_t seed = 1;
  bool print_json = false;
  gonio::thread_count threads;
};

/// The defects of a laboratory, and the noise that calibration assumes.
struct laboratory {
  std::string name;
  lab::sensor chip;
  lab::defects wrong;
  gonio::capture::sensor_noise noise;
};

std::array<laboratory, 4> laboratories(double outliers) {
  const gonio::capture::sensor_noise usual_noise{.read = 1.6, .shot = 0.2, .relative = 0.01};
  const lab::defects noise{.vignetting = 0.1, .flicker = 0.01}, usual = lab::defects::usual();
  lab::defects with_outliers = usual;
  with_outliers.outliers = outliers;
  return {{{"nothing", {}, {}, {.read = 0.0, .relative = 0.0}},
           {"noise", lab::sensor::usual(), noise, usual_noise},
           {"noise, misplaced", lab::sensor::usual(), usual, usual_noise},
           {"noise, misplaced, outliers", lab::sensor::usual(), with_outliers, usual_noise}}};
}

/// Returns the poses of the first `most` pairs that the machine can reach, or of all if there are fewer.
std::vector<gonio::direction_pair> reachable(const laboratory_options& options,
                                             const std::vector<gonio::direction_pair>& pairs, std::size_t most) {
  lab::dark_room room(lab::white(), {}, {});
  std::vector<gonio::direction_pair> poses;
  with_machine(options.machine, room, [&](const auto& machine) {
    for (const gonio::direction_pair& pair : pairs) {
      if (poses.size() == most) return;
      const gonio::capture::placement found = gonio::capture::place_either_way(machine, pair);
      if (found.is_reachable()) poses.push_back(found.at);
    }
  });
  if (poses.empty()) gonio::refuse("the machine can measure none of the directions");
  return poses;
}

std::vector<gonio::direction_pair> random_poses(const laboratory_options& options, Eigen::Index count) {
  const gonio::valid_cells cells;
  // Shuffle the chosen cells: they are sorted by theta_h, so the first ones would all be in the highlight.
  std::vector<gonio::direction_pair> pairs;
  for (const Eigen::Index cell : gonio::random_choice(cells.size(), std::min(3 * count, cells.size()), options.seed))
    pairs.push_back(gonio::to_directions(cells.angles(cell)));
  std::ranges::shuffle(pairs, std::mt19937_64(options.seed));
  return reachable(options, pairs, count);
}

/// Returns the measurements of a table in a laboratory.
std::vector<gonio::capture::measured_reflectance> measure(const laboratory_options& options, const laboratory& where,
                                                          const gonio::brdf_table& table,
                                                          const std::vector<gonio::direction_pair>& poses,
                                                          std::uint64_t seed) {
  const lab::surface surface = [&](const gonio::direction& wi, const gonio::direction& wo) { return table(wi, wo); };
  lab::dark_room reference(lab::white(), where.chip, where.wrong, seed, 2 * seed + 1);
  lab::dark_room material(surface, where.chip, where.wrong, seed, 2 * seed);
  const auto scan = [&](lab::dark_room& room) {
    return with_machine(options.machine, room, [&](auto& machine) { return lab::measure_all(machine, poses); });
  };
  auto measured = lab::calibrate(scan(material), scan(reference), poses, where.chip, where.noise);
  std::erase_if(measured, [](const auto& each) { return !each.is_usable(); });
  return measured;
}

/// Errors of samples against the measured table.
struct sample_errors {
  std::vector<double> relative;  ///< errors of the sum over the channels
  double within = 0.0;           ///< number of channels whose 95 % interval contains the truth
  double channels = 0.0;

  void add(const gonio::capture::measured_reflectance& found, const gonio::brdf_table& truth) {
    const gonio::rgb expected = truth(found.at.wi, found.at.wo), off = found.value - expected;
    relative.push_back(std::abs(off.sum() / expected.sum()));
    for (Eigen::Index channel = 0; channel < 3; ++channel, ++channels)
      if (std::abs(off[channel]) < 1.96 * found.deviation[channel]) ++within;
  }
};

using method_of = reconstruction (*)(const reconstruct_options&, const gonio::sample_set&);

/// Returns one row of the table: errors over repetitions.
json errors_of(const laboratory_options& options, const laboratory& where, const gonio::brdf_table& truth,
               const std::vector<gonio::direction_pair>& poses, method_of method, std::size_t repetitions,
               const gonio::appearance_metric& appearance, const gonio::log_relative_pca& prior) {
  reconstruct_options how;
  how.materials.prior = options.prior;
  how.threads = options.threads;
  std::vector<material_result> results;
  sample_errors of_samples;
  for (std::size_t r = 0; r < repetitions; ++r) {
    gonio::sample_set samples;
    for (const auto& found : measure(options, where, truth, poses, options.seed + r)) {
      samples.push_back(found.as_sample());
      of_samples.add(found, truth);
    }
    const auto estimate = gonio::resample(method(how, samples).table, truth.cells(), options.threads);
    results.push_back({"", gonio::compare(estimate, truth, prior.metric(), appearance, options.threads)});
  }
  json errors = mean_errors(results);
  const distribution relative(of_samples.relative);
  errors["samples"] = of_samples.relative.size() / repetitions;
  errors["sample_error_median"] = relative.median;
  errors["sample_error_worst"] = relative.worst;
  // Without noise there are no intervals.
  if (where.noise.relative > 0.0) errors["within_95"] = of_samples.within / of_samples.channels;
  return errors;
}

void print(const json& result) {
  std::cout << "| material | samples | what is wrong | their error, % (median, worst) | 95 % intervals hold, % | "
               "mapped rms | Delta E env | Delta E lights | peak ratio "
               "|\n|---|---|---|---|---|---|---|---|---|\n";
  for (const json& line : result.elements())
    std::cout << "| " << line["material"].text() << " | " << line["errors"]["samples"] << " by "
              << line["method"].text() << " | " << line["wrong"].text() << " | "
              << fixed(100.0 * line["errors"]["sample_error_median"].number(), 3) << ", "
              << fixed(100.0 * line["errors"]["sample_error_worst"].number(), 3) << " | "
              << (line["errors"].contains("within_95") ? fixed(100.0 * line["errors"]["within_95"].number(), 0) : "")
              << " | " << fixed(line["errors"]["mapped_rms"], 3) << " | " << fixed(line["errors"]["delta_e_env"], 2)
              << " | " << fixed(line["errors"]["delta_e_lights"], 2) << " | " << fixed(line["errors"]["peak_ratio"], 2)
              << " |\n";
}

void run(const laboratory_options& options) {
  const auto prior = gonio::io::read_prior(options.prior);
  const auto few = reachable(options, gonio::io::read_direction_pairs(options.directions), SIZE_MAX);
  const auto many = options.many > 0 ? random_poses(options, options.many) : few;
  progress_bar bar;
  json result = json::array();
  for (const std::filesystem::path& file : options.tables) {
    const auto truth = gonio::io::read_merl_any(file);
    const gonio::appearance_metric appearance(truth.cells(), 36, options.threads);
    const auto add = [&](const laboratory& where, const char* method, const json& errors) {
      const std::string name = file.filename().string();
      result.push_back({{"material", name.substr(0, name.find('.'))},
                        {"method", method},
                        {"wrong", where.name},
                        {"errors", errors}});
    };
    for (const laboratory& where : laboratories(options.outliers)) {
      bar.draw(file.filename().string() + ", " + where.name, 0.0);
      add(where, "pca",
          errors_of(options, where, truth, few, reconstruct_by_components, options.repetitions, appearance, prior));
      if (options.many == 0) continue;
      add(where, "correction",
          errors_of(options, where, truth, many, reconstruct_by_corrections, 1, appearance, prior));
    }
  }
  bar.wipe();
  if (options.print_json)
    std::cout << result.dump(2) << '\n';
  else
    print(result);
}

}  // namespace

void add_laboratory(command& app) {
  auto command =
      app.add_subcommand("laboratory", "Tables scanned, calibrated and reconstructed in a simulated laboratory");
  const auto options = std::make_shared<laboratory_options>();
  command.add_input("tables", options->tables, "Tables to put into the machine (.binary or .binary.gz)").required();
  command.add_input("--directions", options->directions, "A few directions, for pca (.csv)").required();
  command.add_option("--many", options->many, "Number of random directions for correction; 0: do not run correction")
      .capture_default_str();
  add_prior_option(command, options->prior);
  add_machine_options(command, options->machine);
  command
      .add_option("--outliers", options->outliers,
                  "Share of poses that are outliers: their light is multiplied by a random factor from 0.1 to 10")
      .check(check::range(0.0, 1.0))
      .capture_default_str();
  command
      .add_option("--repetitions", options->repetitions,
                  "Number of laboratories over which the errors of pca are averaged")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of the first laboratory").capture_default_str();
  command.add_flag("--json", options->print_json, "Print as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace papers
