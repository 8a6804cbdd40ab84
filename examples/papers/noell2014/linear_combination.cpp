/// gonio-papers linear-combination: Noell et al. 2014, the LC estimate from full data under three metrics.

#include "papers/noell2014/linear_combination.hpp"

#include "papers/experiments.hpp"
#include "papers/material_result.hpp"
#include "papers/mean_errors.hpp"
#include "papers/networks_option.hpp"
#include "tool/files/json.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/metric/root.hpp>
#include <gonio/solve/nnls.hpp>

#include <iostream>
#include <memory>

namespace papers {

namespace {

struct combination_options {
  std::filesystem::path networks;
  bool print_json = false;
  gonio::thread_count threads;
};

/// Results of a numpy reference: mean Delta E under the environment.
constexpr std::array reference_delta_e{16.4, 6.41, 8.82};

class combination_experiment {
 public:
  combination_experiment(const combination_options& options, const gonio::progress& listener)
      : threads_(options.threads),
        materials_(gonio::model::tabulate_networks(gonio::io::read_networks(options.networks), gonio::valid_cells(),
                                                   threads_, listener)),
        relative_(gonio::log_relative::to_median_of(materials_, threads_)),
        appearance_(materials_.cells, 36, threads_) {}

  template <gonio::error_metric Metric>
  [[nodiscard]] std::vector<material_result> run(const Metric& metric) const {
    const papers::leave_one_out_decomposition others{gonio::measured{materials_, metric, threads_}, gonio::nnls{},
                                                     threads_};
    return combine_others(others, gonio::nielsen_test_materials(), materials_, relative_, appearance_, threads_);
  }

 private:
  gonio::thread_count threads_;
  gonio::material_set materials_;
  gonio::log_relative relative_;
  gonio::appearance_metric appearance_;
};

void run_combination(const combination_options& options) {
  progress_bar bar;
  const auto listener = bar.listener();
  const combination_experiment experiment(options, listener);
  // Combine the other materials under each metric.
  std::vector<std::pair<std::string, std::vector<material_result>>> results;
  const auto run_one = [&](const std::string& name, const auto& metric) {
    gonio::report(listener, "combining under " + name, 0.0);
    results.emplace_back(name, experiment.run(metric));
  };
  run_one("lin", gonio::lin{});
  run_one("root", gonio::root{});
  run_one("log", gonio::log{});
  bar.wipe();

  // Print the errors.
  if (options.print_json) {
    json all;
    for (const auto& [name, materials] : results)
      all[name] = {{"means", mean_errors(materials)}, {"materials", errors_by_name(materials)}};
    std::cout << all.dump(2) << '\n';
    return;
  }
  std::cout << "Means over " << gonio::nielsen_test_materials().size()
            << " test materials, each a non-negative combination of the 99 others, from full data.\n\n"
            << "| metric | reference Delta E env | Delta E env | Delta E lights | mapped rms | peak ratio |\n"
            << "|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto& [name, materials] = results[i];
    const json means = mean_errors(materials);
    std::cout << "| " << name << " | " << fixed(reference_delta_e[i], 2) << " | " << fixed(means["delta_e_env"], 2)
              << " | " << fixed(means["delta_e_lights"], 2) << " | " << fixed(means["mapped_rms"], 3) << " | "
              << fixed(means["peak_ratio"], 2) << " |\n";
  }
}

}  // namespace

void add_linear_combination(command& app) {
  auto command = app.add_subcommand("linear-combination",
                                    "Noell et al. 2014: ten materials as non-negative combinations of the 99 others");
  const auto options = std::make_shared<combination_options>();
  add_networks_option(command, options->networks);
  command.add_flag("--json", options->print_json, "Print everything, with each material, as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run_combination(*options); });
}

}  // namespace papers
