/// gonio-papers noell-corrections: Noell, Koehler and Stricker 2014, section 2: whether a correction function is a
/// combination of the others.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "papers/noell2014/correction_check.hpp"
#include "tool/files/json.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/io/materials/networks.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/solve/least_squares.hpp>

#include <iostream>
#include <memory>

namespace papers {

namespace {

struct corrections_options {
  std::filesystem::path networks;
  bool print_json = false;
  gonio::thread_count threads;
};

void run_corrections(const corrections_options& options) {
  progress_bar bar;
  const auto listener = bar.listener();
  // Tabulate the materials.
  const gonio::measured materials{gonio::model::tabulate_networks(gonio::io::read_networks(options.networks),
                                                                  gonio::valid_cells(), options.threads, listener),
                                  gonio::log{}, options.threads};
  struct row {
    std::string rule, solver;
    std::vector<double> deviations;
  };
  std::vector<row> rows;
  // Make the correction functions by both rules, and combine each function from the other functions.
  const auto check = [&](const std::string& rule, const gonio::correction_rule& how) {
    gonio::report(listener, "making correction functions", 0.0);
    const gonio::correction functions{materials, how, gonio::nnls{}, options.threads};
    rows.push_back({rule, "NNLS", deviations_from_others(functions, gonio::nnls{}, options.threads)});
    rows.push_back({rule, "least squares", deviations_from_others(functions, gonio::least_squares{}, options.threads)});
  };
  check("as printed", gonio::correction_rule::as_printed());
  check("gonio's default", {});
  bar.wipe();
  // Print the deviations of the combinations.
  if (options.print_json) {
    json all = json::array();
    for (const row& each : rows)
      all.push_back({{"rule", each.rule}, {"solver", each.solver}, {"deviations", each.deviations}});
    std::cout << all.dump(1) << '\n';
    return;
  }
  std::cout << "Mean |C - combination of the others| over all cells and channels, of " << materials.size()
            << " correction functions. The paper prints 0.076.\n\n"
            << "| correction functions | solver | mean | median | worst |\n|---|---|---|---|---|\n";
  for (const row& each : rows) {
    const distribution all(each.deviations);
    std::cout << "| " << each.rule << " | " << each.solver << " | " << fixed(all.mean, 3) << " | "
              << fixed(all.median, 3) << " | " << fixed(all.worst, 3) << " |\n";
  }
}

}  // namespace

void add_noell_corrections(command& app) {
  auto command = app.add_subcommand(
      "noell-corrections", "Noell et al. 2014, section 2: correction functions as combinations of one another");
  const auto options = std::make_shared<corrections_options>();
  add_networks_option(command, options->networks);
  command.add_flag("--json", options->print_json, "Print everything, with each material, as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run_corrections(*options); });
}

}  // namespace papers
