/// gonio-papers noell-measured: real measurements of materials outside a database, reconstructed by robust estimation
/// (after Noell, Koehler and Stricker 2014) from some of their samples.

#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "papers/noell2014/noell_measures.hpp"
#include "papers/noell2014/noell_tables.hpp"
#include "papers/our_own/scattered_errors.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/rbf.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/interpolate/pull_push.hpp>
#include <gonio/io/materials/merl_directory.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/robust/robust_reconstruction.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <iostream>
#include <memory>

namespace papers {

namespace {

/// The penalty of radial basis functions, as in Table 1.
const gonio::tikhonov radial_penalty{1e-6};

struct measured_options {
  std::filesystem::path networks, environment, tables;
  std::vector<std::filesystem::path> samples;
  double data_ratio = 0.1;
  std::vector<double> outlier_ratios{0.0, 0.2};
  std::vector<std::string> methods{"our", "printed", "lc"};
  std::uint64_t seed = 1;
  bool print_json = false;
  gonio::thread_count threads;
};

/// The materials on some cells, their corrections, and the measures of error.
struct benchmark_setup {
  benchmark_setup(const measured_options& given, const gonio::valid_cells& cells, const gonio::progress& listener)
      : methods(given.methods),
        threads(given.threads),
        materials(gonio::model::tabulate_networks(gonio::io::read_networks(given.networks), cells, threads, listener),
                  gonio::log{}, threads),
        corrections(materials, {}, gonio::nnls{}, threads),
        printed_corrections(materials, gonio::correction_rule::as_printed(), gonio::nnls{}, threads),
        measures(cells, given.environment, threads) {}

  /// Calls `use(name, fit)` for each method: ours, the paper's as printed, and the methods with which the paper
  /// compares.
  template <class Use>
  void reconstruct(const gonio::sample_set& samples, double outlier_ratio, Use&& use) const {
    const gonio::decomposition combination{materials, gonio::nnls{}, threads};
    const gonio::relative_deviation_weights weights{noell_gamma(outlier_ratio)};
    const gonio::correction_limits ten_rounds{.smallest_change = 0.0, .inertia = 0.0};
    const auto use_of = [&](const char* name, const auto& estimator) {
      if (std::ranges::find(methods, name) != methods.end()) use(name, estimator.fit(samples));
    };
    use_of("our", gonio::robust_reconstruction{materials, corrections, {}, {}, threads});
    use_of("printed",
           gonio::correction_iteration{combination, printed_corrections, weights, gonio::nnls{}, ten_rounds, threads});
    use_of("lc", combination);
    if (std::ranges::find(methods, "rbf") != methods.end())
      use_of("rbf", gonio::decomposition{gonio::rbf{materials.cells(), gonio::log{}}, radial_penalty, threads});
    use_of("pull-push", gonio::pull_push{materials.cells(), threads});
  }

  std::vector<std::string> methods;
  gonio::thread_count threads;
  gonio::measured<gonio::log> materials;
  gonio::correction corrections, printed_corrections;
  noell_measures measures;
};

json row(const std::string& name, const std::string& method, std::size_t samples, double outlier_ratio) {
  return {{"name", name}, {"method", method}, {"samples", samples}, {"outlier_ratio", outlier_ratio}};
}

/// Prints means over the tables, one row per method and share of outliers.
void print_means(const measured_options& given, const json& rows) {
  std::cout
      << "\nMeans over the tables\n\n| outliers | method | tables | error | Delta E formula light | natural light "
         "|\n|---|---|---|---|---|---|\n";
  for (const double outlier_ratio : given.outlier_ratios)
    for (const std::string& method : given.methods) {
      double count = 0.0, error = 0.0, formula = 0.0, natural = 0.0;
      for (const json& result : rows.elements()) {
        if (result["method"].text() != method || result["outlier_ratio"].number() != outlier_ratio) continue;
        if (!result.contains("delta_e_env")) continue;  // errors on samples, not on a table
        count += 1.0;
        error += result["log_error"].number();
        formula += result["delta_e_env"].number();
        natural += result["delta_e_natural"].number();
      }
      if (count == 0.0) continue;
      std::cout << "| " << fixed(outlier_ratio, 1) << " | " << method << " | " << fixed(count, 0) << " | "
                << fixed(error / count, 3) << " | " << fixed(formula / count, 2) << " | " << fixed(natural / count, 2)
                << " |\n";
    }
}

/// Compares estimates with the whole table.
void judge_table(const measured_options& given, const benchmark_setup& setup, const std::string& name,
                 const gonio::brdf_table& truth, json& rows) {
  const std::size_t count = gonio::share_of(truth.cells().size(), given.data_ratio);
  const auto cells = gonio::random_cells(truth.cells(), count, given.seed);
  for (const double outlier_ratio : given.outlier_ratios)
    setup.reconstruct(gonio::sample_table(truth, cells, {.outlier_ratio = outlier_ratio}, given.seed), outlier_ratio,
                      [&](const std::string& method, const auto& fit) {
                        const gonio::brdf_table estimate = fit.tabulate(truth.cells(), setup.threads);
                        logarithmic_error error;
                        for (Eigen::Index cell = 0; cell < truth.cells().size(); ++cell)
                          error.add(estimate.at(cell), truth.at(cell));
                        json result = row(name, method, count, outlier_ratio);
                        result["log_error"] = error.value();
                        result.update(setup.measures.judge(estimate, truth));
                        rows.push_back(std::move(result));
                      });
}

/// Compares estimates with the measurements that were not used.
void judge_samples(const measured_options& given, const benchmark_setup& setup, const std::filesystem::path& path,
                   json& rows) {
  const gonio::sample_set all = read_measurements(path);
  const std::size_t count = gonio::share_of(all.size(), given.data_ratio);
  const auto [some, others] = gonio::split_samples(all, count, given.seed);
  if (others.empty()) gonio::refuse(path.string() + ": no sample is left for the comparison, expected --data below 1");
  std::uniform_int_distribution<std::size_t> any_sample(0, all.size() - 1);
  for (const double outlier_ratio : given.outlier_ratios) {
    const auto samples = gonio::corrupt(some, {.outlier_ratio = outlier_ratio}, given.seed,
                                        [&](std::mt19937_64& generator) { return all[any_sample(generator)].value; });
    setup.reconstruct(samples, outlier_ratio, [&](const std::string& method, const auto& fit) {
      logarithmic_error error;
      for (const gonio::sample& other : others) {
        const auto [wi, wo] = other.directions.pair();
        error.add(fit(wi, wo), other.value);
      }
      json result = row(path.stem().string(), method, count, outlier_ratio);
      result["log_error"] = error.value();
      rows.push_back(std::move(result));
    });
  }
}

void print(const measured_options& given, const json& rows) {
  if (given.print_json) {
    std::cout << rows.dump(1) << '\n';
    return;
  }
  std::cout
      << "Error: root mean square of ln(f + 0.001) over a table's cells, or over the measurements that were not "
         "used.\n\n"
      << "| material | samples | outliers | method | error | Delta E formula light | natural light | peak ratio |\n"
      << "|---|---|---|---|---|---|---|---|\n";
  const auto figure = [](const json& result, const char* key) {
    return result.contains(key) ? fixed(result[key], 2) : std::string();
  };
  for (const json& result : rows.elements())
    std::cout << "| " << result["name"].text() << " | " << result["samples"] << " | "
              << fixed(result["outlier_ratio"], 1) << " | " << result["method"].text() << " | "
              << fixed(result["log_error"], 3) << " | " << figure(result, "delta_e_env") << " | "
              << figure(result, "delta_e_natural") << " | " << figure(result, "peak_ratio") << " |\n";
}

void run(const measured_options& given) {
  if (given.tables.empty() && given.samples.empty())
    gonio::refuse("there is nothing to reconstruct: give --tables or --samples");
  progress_bar bar;
  json rows = json::array();
  std::unique_ptr<benchmark_setup> setup;  // on the cells of the last table, which the next table often shares
  const auto setup_for = [&](const gonio::valid_cells& cells) -> const benchmark_setup& {
    if (!setup || !(setup->materials.cells() == cells)) {
      setup.reset();  // two would take twice the memory
      setup = std::make_unique<benchmark_setup>(given, cells, bar.listener());
    }
    return *setup;
  };
  if (!given.tables.empty()) {
    const auto files = gonio::io::list_merl_directory(given.tables);
    for (std::size_t f = 0; f < files.size(); ++f) {
      const auto truth = gonio::io::read_merl_any(files[f].path);
      const benchmark_setup& here = setup_for(truth.cells());
      bar.draw(files[f].name, static_cast<double>(f) / static_cast<double>(files.size()));
      judge_table(given, here, files[f].name, truth, rows);
    }
  }
  for (const std::filesystem::path& file : given.samples)
    judge_samples(given, setup_for(setup ? setup->materials.cells() : gonio::valid_cells()), file, rows);
  bar.wipe();
  print(given, rows);
  if (!given.print_json && !given.tables.empty()) print_means(given, rows);
}

}  // namespace

void add_noell_measured(command& app) {
  auto command = app.add_subcommand(
      "noell-measured", "Reconstruct real measurements, some of which are outliers, from the materials of a database");
  const auto options = std::make_shared<measured_options>();
  add_networks_option(command, options->networks);
  add_environment_option(command, options->environment);
  command.add_input_folder("--tables", options->tables, {".binary", ".gz"},
                           "Folder of MERL tables (.binary or .binary.gz)");
  command.add_input("--samples", options->samples,
                    "Measurements in any directions (.csv, or .brdf in Cornell's text format)");
  command.add_option("--data", options->data_ratio, "Share of the data that is measured")
      .check(check::positive_number() & check::range(0.0, 1.0))
      .capture_default_str();
  command.add_option("--outliers", options->outlier_ratios, "Shares of the measurements that are outliers")
      .check(check::range(0.0, 1.0))
      .capture_default_str();
  command.add_option("--methods", options->methods, "Methods: our, printed, lc, rbf, pull-push")
      .check(check::one_of({"our", "printed", "lc", "rbf", "pull-push"}))
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of cells and outliers").capture_default_str();
  command.add_flag("--json", options->print_json, "Print as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace papers
