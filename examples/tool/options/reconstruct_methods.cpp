/// The methods of gonio reconstruct that are a single fit.

#include "reconstruct_methods.hpp"

#include "materials.hpp"
#include "scattered_samples.hpp"
#include "solver_choice.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/measures_as_json.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/basis/rbf.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/errors_in_variables_decomposition.hpp>
#include <gonio/estimate/eta_of_noise.hpp>
#include <gonio/estimate/soft_specular_decomposition.hpp>
#include <gonio/interpolate/pull_push.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/soft_specular_prior.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <variant>

namespace cli {

namespace {

/// The penalty of Nielsen et al. 2015, section 6.
constexpr double published_eta = 40.0;

/// The solver's report.
void describe(const gonio::solution& found, std::size_t samples, reconstruction& result) {
  const auto& [weights, report] = found;
  const gonio::rgb residual = report.residual.array() / std::sqrt(static_cast<double>(samples));
  gonio::rgb used;
  for (Eigen::Index c = 0; c < 3; ++c) used[c] = static_cast<double>((weights.col(c).array() != 0.0).count());
  result.details = {{"mapped_residual_rms", per_channel(residual)},
                    {"kkt_residual", per_channel(report.kkt_residual.array())},
                    {"non_zero_weights", per_channel(used)},
                    {"iterations", report.iterations}};
  result.sentence = "residual in the mapped domain (rms) " + fixed(residual.x(), 3) + ' ' + fixed(residual.y(), 3) +
                    ' ' + fixed(residual.z(), 3) + ", weights that are not zero " + fixed(used.x(), 0) + ' ' +
                    fixed(used.y(), 0) + ' ' + fixed(used.z(), 0);
}

template <class Fit>
reconstruction described(const Fit& fitted, std::size_t samples, gonio::thread_count threads) {
  reconstruction result{fitted.tabulate(gonio::valid_cells(), threads)};
  if (fitted.report()) describe({fitted.weights(), *fitted.report()}, samples, result);
  return result;
}

template <class Basis, class Solver>
reconstruction fit(const Basis& basis, const Solver& solver, const gonio::sample_set& samples,
                   gonio::thread_count threads) {
  return described(gonio::decomposition{basis, solver, threads}.fit(samples), samples.size(), threads);
}

/// Samples whose light and viewer may be off their directions. Noise that is not stated is taken for none:
/// cross-validation would take what is misplaced for noise.
reconstruction reconstruct_misplaced(const reconstruct_options& options, const gonio::log_relative_pca& prior,
                                     const gonio::sample_set& samples) {
  const std::string& stated = options.solver.eta;
  if ((!options.solver.name.empty() && options.solver.name != "tikhonov") || stated == "gcv" || stated == "loo")
    gonio::refuse("--misplaced needs --solver tikhonov, and --noise or a number as its --eta");
  const double eta = stated.empty() ? gonio::eta_of_noise(prior, samples, options.noise.value_or(0.0), options.threads)
                                    : number_of_eta(stated);
  const gonio::errors_in_variables_decomposition estimator{prior, eta, gonio::radians(options.angular_error),
                                                           options.threads};
  reconstruction result = described(estimator.fit(samples), samples.size(), options.threads);
  result.details["eta"] = eta;
  return result;
}

}  // namespace

component_choice choose_components(const reconstruct_options& options) {
  const bool penalised = options.solver.name.empty() || options.solver.name == "tikhonov";
  if (options.noise && !options.solver.eta.empty())
    gonio::refuse("--noise and --eta both set the penalty: give one of them");
  if (options.noise && !penalised)
    gonio::refuse("--noise sets the penalty of --solver tikhonov, not of --solver " + options.solver.name);
  const auto solver = make_solver(options.solver, {"tikhonov", "gcv"});
  if (solver.non_negative())
    gonio::refuse("--solver " + options.solver.name +
                  " finds weights of at least 0, but the signs of principal components are arbitrary: "
                  "give --solver tikhonov, lasso, tsvd or ls, or --method linear");
  if (!options.metric.empty() && options.metric != "log-relative")
    gonio::refuse("--prior was learned under the log-relative metric: --metric " + options.metric +
                  " needs --method linear");
  if (!options.materials.is_prior() || !options.materials.exclude.empty())
    gonio::refuse("--networks, --merl and --exclude need --method linear: the components of --prior are fixed");
  component_choice chosen{gonio::io::read_prior(options.materials.prior), solver};
  chosen.is_penalised = penalised && options.solver.eta.empty();
  chosen.has_discrepancy = options.discrepancy != 0.0 && chosen.is_penalised && options.angular_error == 0.0;
  if (chosen.has_discrepancy) return chosen;
  if (options.keeps_all || !options.residuals.empty() || options.wants_uncertainty())
    gonio::refuse(
        "--no-reject, --residuals, --report, --uncertainty and --uncertainty-image need a discrepancy: they go with "
        "none of "
        "--discrepancy 0, --misplaced, --eta and other solvers than tikhonov");
  if (options.discrepancy != 0.0 && options.discrepancy != reconstruct_options{}.discrepancy)
    gonio::refuse("--discrepancy goes with none of --misplaced, --eta and other solvers than tikhonov");
  return chosen;
}

double chosen_eta(const reconstruct_options& options, const gonio::log_relative_pca& prior,
                  const gonio::sample_set& samples) {
  return options.noise ? gonio::eta_of_noise(prior, samples, *options.noise, options.threads)
                       : gonio::eta_of_unknown_noise(prior, samples, 0.3, options.threads);
}

reconstruction reconstruct_by_components(const reconstruct_options& options, const gonio::sample_set& samples) {
  const auto [prior, solver, has_discrepancy, is_penalised] = choose_components(options);
  if (has_discrepancy) return reconstruct_with_discrepancy(options, prior, samples);
  if (options.angular_error != 0.0) return reconstruct_misplaced(options, prior, samples);
  if (!is_penalised) return fit(prior, solver, samples, options.threads);
  const double eta = chosen_eta(options, prior, samples);
  reconstruction result = fit(prior, gonio::tikhonov(eta), samples, options.threads);
  result.details["eta"] = eta;
  result.sentence += ", eta " + fixed(eta, 3);
  return result;
}

soft_specular_choice choose_soft_or_specular(const reconstruct_options& options, const gonio::sample_set& samples) {
  const std::filesystem::path& file = options.materials.prior;
  if (gonio::io::is_prior(file))
    gonio::refuse({"--method soft-specular needs a --prior that gonio learn --split wrote; ", file.native(),
                   " has one of all materials"});
  auto prior = gonio::io::read_soft_specular_prior(file);
  const std::string& stated = options.solver.eta;
  if (stated == "gcv" || stated == "loo")
    gonio::refuse("--method soft-specular needs a number as its --eta, not " + stated);
  const double eta = stated.empty() ? published_eta : number_of_eta(stated);
  const auto penalties = gonio::penalties_in_proportion(prior, eta);
  auto fitted = gonio::soft_specular_decomposition(prior, penalties, options.threads).fit(samples);
  return {std::move(prior), penalties, std::move(fitted)};
}

void describe(const soft_specular_choice& choice, reconstruction& result) {
  result.details["kind"] = choice.is_soft() ? "soft" : "specular";
  result.details["contrast"] = choice.fitted.contrast();
  result.details["threshold"] = choice.prior.threshold();
  result.details["eta"] = choice.eta();
  result.sentence = std::string("taken for ") + (choice.is_soft() ? "soft" : "specular") +
                    ": a highlight contrast of " + fixed(choice.fitted.contrast(), 2) + ", where " +
                    fixed(choice.prior.threshold(), 2) + " divides; " + result.sentence;
}

reconstruction reconstruct_by_soft_or_specular(const reconstruct_options& options, const gonio::sample_set& samples) {
  const soft_specular_choice choice = choose_soft_or_specular(options, samples);
  reconstruction result = std::visit(
      [&](const auto& chosen) { return described(chosen, samples.size(), options.threads); }, choice.fitted.chosen());
  describe(choice, result);
  return result;
}

gonio::measured<gonio::any_metric> chosen_materials(const reconstruct_options& options,
                                                    const gonio::progress& listener) {
  auto materials = read_materials(options.materials, options.threads, listener);
  const auto metric =
      chosen_metric(options, [&] { return gonio::log_relative::to_median_of(materials, options.threads); });
  const auto left_out = options.materials.is_prior() ? options.materials.exclude : std::vector<std::string>{};
  return gonio::measured{std::move(materials), metric, options.threads}.without(left_out);
}

reconstruction reconstruct_by_materials(const reconstruct_options& options, const gonio::sample_set& samples) {
  const auto solver = make_solver(options.solver, {"nnls", "gcv"});
  progress_bar bar;
  const auto materials = chosen_materials(options, bar.listener());
  bar.wipe();
  return fit(materials, solver, samples, options.threads);
}

gonio::rbf<gonio::any_metric> chosen_radial_functions(const reconstruct_options& options) {
  const gonio::valid_cells cells;
  const auto centres = gonio::farthest_point_centres(cells, gonio::published_centre_count, options.seed);
  const auto metric =
      chosen_metric(options, [&] { return gonio::io::read_prior(options.materials.prior).metric().on(cells); });
  return {cells, metric, centres};
}

reconstruction reconstruct_by_radial_functions(const reconstruct_options& options, const gonio::sample_set& samples) {
  return fit(chosen_radial_functions(options), radial_solver, samples, options.threads);
}

reconstruction reconstruct_by_pull_push(const reconstruct_options& options, const gonio::sample_set& samples) {
  return {gonio::pull_push{gonio::valid_cells(), options.threads}.fit(samples).table()};
}

reconstruction reconstruct_by_neighbours(const reconstruct_options& options, const gonio::sample_set& samples) {
  const interpolated_samples f = interpolate(samples, {.neighbours = options.neighbours});
  reconstruction result{gonio::tabulate(f, gonio::valid_cells(), options.threads)};
  result.details["neighbours"] = options.neighbours;
  const Eigen::Index count = std::min(options.neighbours, std::ssize(samples));
  result.sentence =
      count == 1 ? "the nearest counts" : "the nearest " + std::to_string(count) + " count in each direction";
  return result;
}

}  // namespace cli
