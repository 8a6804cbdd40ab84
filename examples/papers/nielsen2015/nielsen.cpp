/// gonio-papers nielsen-test-materials: Nielsen et al. 2015, section 6, on surrogates of their materials.

#include "papers/experiments.hpp"
#include "papers/mean_errors.hpp"
#include "papers/networks_option.hpp"
#include "papers/nielsen2015/few_samples.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "tool/files/json.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/io/materials/prior.hpp>

#include <iostream>
#include <memory>

namespace papers {

namespace {

struct nielsen_options {
  std::filesystem::path networks;
  double eta = 40.0;
  bool print_json = false;
  gonio::thread_count threads;
};

/// Results of a numpy reference with all components at cell centres and eta = 40, in the mapped domain.
constexpr std::array reference_rms{0.921, 0.775, 0.409, 0.245, 0.238};
constexpr double reference_projection = 0.038;

/// Returns the prior in the form that ships with gonio.
gonio::log_relative_pca as_shipped(const gonio::log_relative_pca& prior) {
  const gonio::grid_extents fine = prior.cells().grid().extents();
  const gonio::valid_cells thin(gonio::grid({fine.theta_h, fine.theta_d / 3, fine.phi_d / 5}));
  const auto encoded =
      gonio::io::write_prior(gonio::thin(prior.truncated(std::min<std::size_t>(60, prior.size())), thin));
  return gonio::io::read_prior(encoded, "the shipped form of the prior");
}

void print_row(const std::string& label, double reference, const json& full, const json* shipped) {
  const auto figures = [](const json& means) {
    return " | " + fixed(means["mapped_rms"], 3) + " | " + fixed(means["delta_e_env"], 2) + " | " +
           fixed(means["delta_e_lights"], 2);
  };
  std::cout << "| " << label << " | " << fixed(reference, 3) << figures(full)
            << (shipped ? figures(*shipped) : " | | |") << " |\n";
}

void run(const nielsen_options& options) {
  progress_bar bar;
  const auto listener = bar.listener();
  // Learn the prior without the test materials.
  const nielsen_split split = nielsen_split::learn({options.networks}, options.threads, listener);
  const auto& prior = split.prior;
  const auto& truths = split.truths;
  const auto shipped = as_shipped(prior);
  const gonio::appearance_metric appearance(truths.cells, 36, options.threads);

  // Reconstruct the test materials from each published set of directions.
  json result{{"prior_components", prior.size()}, {"eta", options.eta}, {"directions", json::object()}};
  for (const Eigen::Index n : gonio::design::nielsen_direction_counts) {
    const auto directions = gonio::design::nielsen_directions(n);
    const auto reconstruct = [&](const gonio::log_relative_pca& from) {
      return reconstruct_from_directions(from, options.eta, directions, truths, prior.metric(), appearance,
                                         options.threads);
    };
    gonio::report(listener, "reconstructing from " + std::to_string(n), 0.0);
    const auto full = reconstruct(prior), thin = reconstruct(shipped);
    result["directions"][std::to_string(n)] = {
        {"full", mean_errors(full)}, {"shipped_form", mean_errors(thin)}, {"materials", errors_by_name(full)}};
  }
  // Project the test materials on the prior: a lower bound for every reconstruction.
  const auto bound = project_on(prior, truths, appearance, options.threads);
  result["projection"] = {{"full", mean_errors(bound)}, {"materials", errors_by_name(bound)}};
  bar.wipe();

  // Print the errors.
  if (options.print_json) {
    std::cout << result.dump(2) << '\n';
    return;
  }
  std::cout << "Means over " << truths.names.size() << " test materials, " << prior.names().size()
            << " learned, eta = " << options.eta << ".\n"
            << "full: " << prior.size() << " components at full resolution; shipped form: " << shipped.size()
            << " components, thinned and quantised.\n\n"
            << "| n | reference rms | full: rms | Delta E env | Delta E lights | shipped form: rms | Delta E env | "
               "Delta E lights |\n"
            << "|---|---|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < reference_rms.size(); ++i) {
    const std::string n = std::to_string(gonio::design::nielsen_direction_counts[i]);
    const json& row = result["directions"][n];
    print_row(n, reference_rms[i], row["full"], &row["shipped_form"]);
  }
  print_row("projection", reference_projection, result["projection"]["full"], nullptr);
}

}  // namespace

void add_nielsen_test_materials(command& app) {
  auto command = app.add_subcommand(
      "nielsen-test-materials",
      "Nielsen et al. 2015: ten materials from 1 to 20 published directions; the prior has learned 90 others");
  const auto options = std::make_shared<nielsen_options>();
  add_networks_option(command, options->networks);
  command.add_option("--eta", options->eta, "Tikhonov's penalty").capture_default_str();
  command.add_flag("--json", options->print_json, "Print everything, with each material, as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace papers
