/// gonio-papers cosine-weight: how the error depends on the weight of reflectance. It is the product of both cosines in
/// Nielsen et al. 2015 (Eq. 2), and the larger cosine in Xu et al. 2016 (section 3).

#include "papers/experiments.hpp"
#include "papers/mean_errors.hpp"
#include "papers/networks_option.hpp"
#include "papers/nielsen2015/few_samples.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "tool/files/json.hpp"
#include "tool/options/chosen_networks.hpp"
#include "tool/options/solver_choice.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/estimate/eta_of_noise.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/test_materials.hpp>

#include <array>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

namespace papers {

namespace {

using gonio::cosine_weighting;

struct cosine_options {
  studied_networks networks;
  std::vector<Eigen::Index> counts{1, 2, 5, 10, 20};
  std::vector<std::string> etas{"40", "auto"};
  bool print_json = false;
  gonio::thread_count threads;
};

constexpr std::array weightings{std::pair{"product", cosine_weighting::product},
                                std::pair{"larger", cosine_weighting::larger}};

/// Returns means over the materials reconstructed from some directions, with a mapped error for each weight.
json judged(const gonio::log_relative_pca& prior, const gonio::material_set& truths, std::size_t count,
            const std::string& eta, const gonio::appearance_metric& appearance, gonio::thread_count threads) {
  const auto cells = gonio::cells_at(truths.cells, gonio::design::nielsen_directions(count));
  std::array<std::vector<material_result>, weightings.size()> results;
  for (std::size_t m = 0; m < truths.names.size(); ++m) {
    const gonio::brdf_table truth = truths.table(m);
    const gonio::sample_set samples = gonio::sample_table(truth, cells);
    const double penalty =
        eta == "auto" ? gonio::eta_of_unknown_noise(prior, samples, 0.3, threads) : number_of_eta(eta);
    const auto estimate =
        gonio::decomposition{prior, gonio::tikhonov{penalty}}.fit(samples).tabulate(truths.cells, threads);
    for (std::size_t w = 0; w < weightings.size(); ++w)
      results[w].push_back(
          {truths.names[m],
           gonio::compare(estimate, truth, prior.metric().weighted_by(weightings[w].second), appearance, threads)});
  }
  json means = mean_errors(results[0]);
  for (std::size_t w = 0; w < weightings.size(); ++w)
    means[std::string("mapped_rms_by_") + weightings[w].first] = mean_errors(results[w])["mapped_rms"];
  return means;
}

void print_row(const json& row) {
  std::cout << "| " << row["n"] << " | " << row["eta"].text() << " | " << row["weight"].text();
  for (const auto& [key, digits] :
       {std::pair{"mapped_rms_by_product", 3}, std::pair{"mapped_rms_by_larger", 3}, std::pair{"cosine_rms", 4},
        std::pair{"delta_e_env", 2}, std::pair{"delta_e_lights", 2}, std::pair{"peak_ratio", 2}})
    std::cout << " | " << fixed(row["errors"][key], digits);
  std::cout << " |\n";
}

void run(const cosine_options& options) {
  // Refuse penalties that are not positive numbers.
  for (const std::string& eta : options.etas)
    if (eta != "auto" && !(number_of_eta(eta) > 0.0)) gonio::refuse("--eta must be positive, or auto");
  progress_bar bar;
  // Tabulate the test materials.
  const auto networks = options.networks.read();
  const auto cells = options.networks.cells();
  const auto truths =
      gonio::model::tabulate_networks(networks_in(networks, gonio::nielsen_test_materials(), options.networks.file),
                                      cells, options.threads, bar.listener());
  const gonio::appearance_metric appearance(cells, 36, options.threads);
  // Reconstruct them with a prior that is mapped with each weight.
  json rows = json::array();
  for (const auto& [name, weighting] : weightings) {
    const auto prior =
        learn_all_components(networks_except(networks, gonio::nielsen_test_materials(), options.networks.file), cells,
                             options.threads, bar.listener(), weighting);
    for (const Eigen::Index n : options.counts)
      for (const std::string& eta : options.etas) {
        gonio::report(bar.listener(), std::string("weight ") + name + ", " + std::to_string(n), 0.0);
        rows.push_back({{"n", n},
                        {"eta", eta},
                        {"weight", name},
                        {"errors", judged(prior, truths, n, eta, appearance, options.threads)}});
      }
  }
  bar.wipe();
  // Print the errors.
  if (options.print_json) {
    std::cout << rows.dump(2) << '\n';
    return;
  }
  std::cout << "| n | eta | weight | rms, mapped with the product | rms, mapped with the larger | cosine rms | Delta E "
               "env | Delta E lights | peak |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const Eigen::Index n : options.counts)
    for (const json& row : rows.elements())
      if (row["n"].number() == static_cast<double>(n)) print_row(row);
}

}  // namespace

void add_cosine_weight(command& app) {
  auto command = app.add_subcommand("cosine-weight",
                                    "Compare two weights of reflectance: the product of both cosines (Nielsen 2015), "
                                    "and the larger cosine (Xu 2016)");
  const auto options = std::make_shared<cosine_options>();
  add_networks_option(command, options->networks);
  add_counts_option(command, options->counts);
  command
      .add_option("--eta", options->etas, "Tikhonov's penalties: numbers, or auto, as `gonio reconstruct` chooses it")
      .capture_default_str();
  command.add_flag("--json", options->print_json, "Print everything as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace papers
