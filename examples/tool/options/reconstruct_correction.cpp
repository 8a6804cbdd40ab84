/// gonio reconstruct --method correction.

#include "materials.hpp"
#include "reconstruct_methods.hpp"
#include "tool/files/file_kinds.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/iteration_figure.hpp"
#include "tool/pages/method_record.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/inliers.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/robust/robust_reconstruction.hpp>

#include <algorithm>

namespace cli {

namespace {

/// Returns the number of --gamma, or nothing for auto. With --as-printed, auto is 3: the paper has no auto.
std::optional<double> gamma_of(const reconstruct_options& options) {
  constexpr double usual = 3.0;
  const std::string& text = options.gamma;
  if (text == "auto") return options.as_printed ? std::optional(usual) : std::nullopt;
  double gamma = 0.0;
  if (gonio::io::read_number(text, gamma) || gamma < 0.0)
    gonio::refuse("--gamma needs a number of at least 0, or auto, not '" + text + "'");
  return gamma;
}

/// Makes the folder before the work: a failure after it would lose the result.
void make_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) gonio::refuse(folder.string() + ": cannot create the folder: " + failed.message());
}

template <class Run>
void describe(const Run& run, bool converged, bool automatic, reconstruction& result) {
  const gonio::correction_round& last = run.history().back();
  const std::size_t rounds = run.history().size();
  result.history = run.history();
  result.details = {{"rounds", rounds},
                    {"converged", converged},
                    {"error", last.error},
                    {"change", last.change},
                    {"down_weighted", last.down_weighted}};
  result.sentence = counted(rounds, "round") + ", relative error before the last round " + fixed(last.error, 3) + ", " +
                    fixed(100.0 * last.down_weighted, 1) + " % down-weighted";
  if (!automatic) return;
  // A few samples can prove only a limited fraction of outliers.
  const Eigen::Index samples = run.measured().cols();
  double outliers = 1.0 - gonio::automatic_weights{}.mixture(run.measured(), run.estimated()).inlier_fraction;
  if (samples < fewest_corrected_samples) outliers = std::min(outliers, gonio::largest_outlier_share(samples));
  result.details["outliers"] = outliers;
  result.sentence += ", about " + fixed(100.0 * outliers, 1) + " % outliers";
}

/// Steps until the run ends, observed by a figure if there is one.
template <class Run>
reconstruction iterate(Run run, const reconstruct_options& options, bool automatic, iteration_figure* watcher,
                       progress_bar& bar) {
  if (watcher) watcher->look(run);
  while (!run.converged()) {
    bar.draw("correcting", static_cast<double>(run.history().size()) / options.iterations);
    run.step();
    if (watcher) watcher->look(run);
  }
  reconstruction result{run.result().tabulate(gonio::valid_cells(), options.threads)};
  describe(run, run.history().back().change < gonio::correction_limits{}.smallest_change, automatic, result);
  return result;
}

/// Runs the method chosen by --gamma, with materials under a metric.
reconstruction correct(const gonio::measured<gonio::any_metric>& materials, const reconstruct_options& options,
                       const gonio::sample_set& samples, std::optional<gonio::brdf_table> truth, progress_bar& bar) {
  // Make the correction functions.
  const auto gamma = gamma_of(options);
  const gonio::thread_count threads = options.threads;
  gonio::correction_limits limits{.rounds = options.iterations};
  if (options.as_printed) limits.inertia = 0.0;
  if (!options.iteration_figure.empty()) make_folder(options.iteration_figure);
  bar.draw("making correction functions", 0.0);
  const auto rule = options.as_printed ? gonio::correction_rule::as_printed() : gonio::correction_rule{};
  const gonio::correction corrections{materials, rule, gonio::nnls{}, threads};
  std::optional<iteration_figure> watched;
  if (!options.iteration_figure.empty()) watched.emplace(corrections, samples, std::move(truth), threads);
  iteration_figure* watcher = watched ? &*watched : nullptr;

  // Iterate with the weights of the paper if gamma is given, else with automatic ones.
  const auto as_published = [&] {
    const gonio::decomposition initial{materials, gonio::nnls{}, threads};
    const gonio::relative_deviation_weights weighting{*gamma};
    const gonio::correction_iteration method{initial, corrections, weighting, gonio::nnls{}, limits, threads};
    return iterate(method.initialise(samples), options, false, watcher, bar);
  };
  const auto automatic = [&] {
    const gonio::robust_start start{.seed = options.seed};
    const gonio::robust_reconstruction robust{materials, corrections, limits, start, threads};
    return iterate(robust.initialise(samples), options, true, watcher, bar);
  };
  reconstruction result = gamma ? as_published() : automatic();
  if (!watched) return result;

  // Draw the iteration figure.
  bar.draw("drawing", 1.0);
  auto [image, differences] = watched->draw();
  result.iteration_figure = std::move(image);
  for (const auto& [round, difference] : differences)
    result.details["delta_e_env"].push_back({{"round", round}, {"mean", difference}});
  if (!differences.empty())
    result.sentence += ", Delta E " + fixed(differences.front().second, 2) + " at first and " +
                       fixed(differences.back().second, 2) + " at last";
  return result;
}

}  // namespace

reconstruction reconstruct_by_corrections(const reconstruct_options& options, const gonio::sample_set& samples) {
  static_cast<void>(gamma_of(options));  // refuse a wrong --gamma before the work
  const Eigen::Index counting = std::ssize(gonio::counting_positions(samples));
  if (counting < fewest_corrected_samples && !options.has_own_options) {
    reconstruction result = reconstruct_with_discrepancy(options, prior_of(options.materials), samples);
    result.warnings.push_back("--method correction needs at least " + std::to_string(fewest_corrected_samples) +
                              " samples, not " + std::to_string(counting) + ": used --method pca instead");
    return result;
  }
  std::optional<gonio::brdf_table> truth;
  if (!options.truth.empty()) truth = read_table(options.truth);
  progress_bar bar;
  const auto materials = chosen_materials(options, bar.listener());
  return correct(materials, options, samples, std::move(truth), bar);
}

}  // namespace cli
