/// gonio-papers soft-specular: Nielsen et al. 2015, section 8: one prior compared with a prior for soft and one for
/// specular materials.

#include "papers/experiments.hpp"
#include "papers/material_result.hpp"
#include "papers/mean_errors.hpp"
#include "papers/networks_option.hpp"
#include "papers/nielsen2015/few_samples.hpp"
#include "tool/files/json.hpp"
#include "tool/options/chosen_networks.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/learn_pca.hpp>
#include <gonio/basis/soft_specular_prior.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/estimate/highlight_contrast.hpp>
#include <gonio/estimate/soft_or_specular.hpp>
#include <gonio/estimate/soft_specular_decomposition.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <functional>
#include <iostream>
#include <memory>
#include <optional>

namespace papers {

namespace {

struct soft_specular_options {
  studied_networks networks;
  std::vector<Eigen::Index> counts{2, 5};
  double eta = 40.0;
  std::optional<double> eta_of_halves, threshold;
  bool print_json = false;
  gonio::thread_count threads;
};

using ridge = gonio::ridge_reconstruction;

/// One estimator for all materials, and one for each half of them.
struct rivals {
  ridge all;
  gonio::soft_or_specular<ridge, ridge> switching;
  gonio::soft_specular_prior halves;
  gonio::soft_specular_penalties eta;  ///< of the halves
};

/// A row of the table: the results chosen for the materials.
struct chosen_results {
  std::string label;
  std::vector<material_result> results;
};

/// The material whose errors the paper shows (Figure 2): soft, and not captured by the single prior.
constexpr auto papers_example = "white-fabric";

/// Returns penalties in proportion to the number of materials in each half, or the value of --eta-of-halves.
gonio::soft_specular_penalties penalties_of(const soft_specular_options& options,
                                            const gonio::soft_specular_prior& prior) {
  if (options.eta_of_halves) return {*options.eta_of_halves, *options.eta_of_halves};
  return gonio::penalties_in_proportion(prior, options.eta);
}

rivals learn_rivals(const soft_specular_options& options, gonio::material_set training,
                    const gonio::progress& listener) {
  constexpr Eigen::Index every_component = 300;
  const auto metric = gonio::log_relative::to_median_of(training, options.threads);
  auto halves =
      gonio::learn_soft_specular_prior(training, metric, every_component, options.threshold, options.threads, listener);
  const auto eta = penalties_of(options, halves);
  auto switching = gonio::soft_specular_decomposition(halves, eta);
  auto all = gonio::learn_pca(std::move(training), metric, every_component, options.threads, listener);
  return {ridge{std::move(all), gonio::tikhonov{options.eta}}, std::move(switching), std::move(halves), eta};
}

/// Returns for each material m the second result if `takes_second(m)`, otherwise the first.
template <class Choice>
std::vector<material_result> choose(const std::vector<material_result>& first,
                                    const std::vector<material_result>& second, Choice&& takes_second) {
  std::vector<material_result> chosen = first;
  for (std::size_t m = 0; m < chosen.size(); ++m)
    if (takes_second(m)) chosen[m] = second[m];
  return chosen;
}

std::vector<material_result> better(const std::vector<material_result>& first,
                                    const std::vector<material_result>& second,
                                    const std::function<double(const gonio::comparison&)>& measure) {
  return choose(first, second, [&](std::size_t m) { return measure(second[m].errors) < measure(first[m].errors); });
}

double mapped_rms(const gonio::comparison& errors) { return errors.mapped_rms.mean(); }
double delta_e_env(const gonio::comparison& errors) { return errors.delta_e_env; }

/// Returns all rows for `count` directions. If these directions cannot tell soft from specular materials, the switch by
/// samples has no row.
std::vector<chosen_results> reconstruct_all_ways(const rivals& from, const gonio::material_set& truths,
                                                 const gonio::appearance_metric& appearance, std::size_t count,
                                                 gonio::thread_count threads) {
  const auto cells = gonio::cells_at(truths.cells, gonio::design::nielsen_directions(count));
  const gonio::log_relative& metric = from.halves.metric();
  const auto reconstruct = [&](const ridge& estimator) {
    return reconstruct_from_cells(estimator, cells, truths, metric, appearance, threads);
  };
  const auto all = reconstruct(from.all), soft = reconstruct(from.switching.soft()),
             specular = reconstruct(from.switching.specular());
  std::vector<chosen_results> rows{{"one prior", all}, {"soft prior", soft}, {"specular prior", specular}};
  const auto samples_of = [&](std::size_t m) { return gonio::sample_table(truths.table(m), cells); };
  if (gonio::highlight_contrast(metric, samples_of(0)))
    rows.push_back({"switch by the samples", choose(soft, specular, [&](std::size_t m) {
                      return from.switching.choose(samples_of(m)) == gonio::material_kind::specular;
                    })});
  rows.push_back({"switch by the whole table", choose(soft, specular, [&](std::size_t m) {
                    return gonio::highlight_contrast(metric, truths.table(m), {}, threads) >=
                           from.switching.threshold();
                  })});
  rows.push_back({"oracle: the better rms", better(soft, specular, mapped_rms)});
  rows.push_back({"oracle: the better Delta E env", better(soft, specular, delta_e_env)});
  return rows;
}

void print_row(std::size_t count, const chosen_results& row) {
  const json means = mean_errors(row.results);
  std::cout << "| " << count << " | " << row.label << " | " << fixed(means["mapped_rms"], 3) << " | "
            << fixed(means["delta_e_env"], 2) << " | " << fixed(means["delta_e_lights"], 2);
  const auto example = std::ranges::find(row.results, papers_example, &material_result::name);
  std::cout << " | " << fixed(mapped_rms(example->errors), 3) << " | " << fixed(delta_e_env(example->errors), 2)
            << " | " << fixed(example->errors.delta_e_lights, 2) << " |\n";
}

void print_heading(const rivals& from, const gonio::material_set& truths, const soft_specular_options& options) {
  const gonio::soft_specular_prior& halves = from.halves;
  std::cout << "Means over " << truths.names.size() << " test materials, " << halves.materials()
            << " learned, eta = " << options.eta << "; by contrast " << halves.soft().names().size()
            << " are soft (eta = " << fixed(from.eta.soft, 1) << ") and " << halves.specular().names().size()
            << " specular (eta = " << fixed(from.eta.specular, 1) << "), parted at " << fixed(halves.threshold(), 3)
            << ".\n\n"
            << "| n | prior | rms | Delta E env | Delta E lights | " << papers_example
            << ": rms | Delta E env | Delta E lights |\n|---|---|---|---|---|---|---|---|\n";
}

void run(const soft_specular_options& options) {
  progress_bar bar;
  const auto listener = bar.listener();
  const auto networks = options.networks.read();
  const auto cells = options.networks.cells();
  const auto& names = gonio::nielsen_test_materials();
  const auto truths =
      gonio::model::tabulate_networks(networks_in(networks, names, options.networks.file), cells, options.threads);
  const rivals from =
      learn_rivals(options,
                   gonio::model::tabulate_networks(networks_except(networks, names, options.networks.file), cells,
                                                   options.threads, listener),
                   listener);
  const gonio::appearance_metric appearance(cells, 36, options.threads);

  json result{{"threshold", from.halves.threshold()},
              {"soft_materials", from.halves.soft().names()},
              {"specular_materials", from.halves.specular().names()},
              {"directions", json::object()}};
  if (!options.print_json) print_heading(from, truths, options);
  for (const Eigen::Index count : options.counts) {
    gonio::report(listener, "reconstructing from " + std::to_string(count), 0.0);
    for (const chosen_results& row : reconstruct_all_ways(from, truths, appearance, count, options.threads)) {
      if (!options.print_json) print_row(count, row);
      result["directions"][std::to_string(count)][row.label] = {{"mean", mean_errors(row.results)},
                                                                {"materials", errors_by_name(row.results)}};
    }
  }
  bar.wipe();
  if (options.print_json) std::cout << result.dump(2) << '\n';
}

}  // namespace

void add_soft_specular(command& app) {
  auto command = app.add_subcommand("soft-specular",
                                    "Compare one prior with a soft and a specular prior on ten materials; the priors "
                                    "have learned 90 others (Nielsen 2015)");
  const auto options = std::make_shared<soft_specular_options>();
  add_networks_option(command, options->networks);
  command.add_option("-n,--counts", options->counts, "Numbers of the published directions: 1, 2, 5, 10, 20")
      .check(check::one_of({1, 2, 5, 10, 20}))
      .capture_default_str();
  command.add_option("--eta", options->eta, "Tikhonov's penalty of the single prior").capture_default_str();
  command.add_option(
      "--eta-of-halves", options->eta_of_halves,
      "Penalties of the soft and the specular prior (default: in proportion to their numbers of materials)");
  command.add_option("--threshold", options->threshold,
                     "Contrast above which a material is specular (default: the median of the 90)");
  command.add_flag("--json", options->print_json, "Print everything, with each material, as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace papers
