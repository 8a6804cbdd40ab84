/// The methods of gonio reconstruct that are a single fit.

#include "reconstruct_methods.hpp"

#include "materials.hpp"
#include "scattered_samples.hpp"
#include "shipped_data.hpp"
#include "solver_choice.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/basis/rbf.hpp>
#include <gonio/estimate/decomposition.hpp>
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

namespace cli {

namespace {

/// The penalty of Nielsen et al. 2015, section 6.
constexpr double published_eta = 40.0;

/// The prior and the solver for `--method pca`, after unsupported options are refused.
struct component_choice {
  gonio::log_relative_pca prior;
  gonio::any_solver solver;
  bool has_discrepancy = false, is_penalised = false;  ///< is_penalised: by Tikhonov, without --eta
};

template <class Fit>
reconstruction described(const Fit& fitted, const gonio::sample_set& samples, const reconstruct_options& options) {
  reconstruction result = tabulated(fitted, options);
  describe_residuals(*fitted.report(), std::ssize(samples), result);
  const Eigen::ArrayXd used = (fitted.weights().array() != 0.0).template cast<double>().colwise().sum();
  result.details["non_zero_weights"] = listed(used);
  result.details["iterations"] = fitted.report()->iterations;
  result.sentence += ", nonzero weights " + in_words(used, 0);
  return result;
}

template <class Basis, class Solver>
reconstruction fit(const Basis& basis, const Solver& solver, const gonio::sample_set& samples,
                   const reconstruct_options& options) {
  return described(gonio::decomposition{basis, solver, options.threads}.fit(samples), samples, options);
}

component_choice choose_components(const reconstruct_options& options) {
  const bool penalised = options.solver.name.empty() || options.solver.name == "tikhonov";
  if (options.noise && !options.solver.eta.empty())
    gonio::refuse("--noise and --eta exclude each other: give one of them");
  if (options.noise && !penalised) gonio::refuse("--noise needs --solver tikhonov, not " + options.solver.name);
  const auto solver = make_solver(options.solver, {"tikhonov", "gcv"});
  if (solver.non_negative())
    gonio::refuse("--solver " + options.solver.name +
                  " finds weights of at least 0, but principal components have arbitrary signs: give --solver "
                  "tikhonov, lasso, tsvd or ls, or --method linear");
  if (!options.metric.empty() && options.metric != "log-relative")
    gonio::refuse("--prior was learned with the log-relative metric: --metric " + options.metric +
                  " needs --method linear");
  if (!options.materials.is_prior() || !options.materials.exclude.empty())
    gonio::refuse("--networks, --merl, --rgl and --exclude need --method linear: the components of --prior are fixed");
  component_choice chosen{prior_of(options.materials), solver};
  chosen.is_penalised = penalised && options.solver.eta.empty();
  chosen.has_discrepancy = options.discrepancy != 0.0 && chosen.is_penalised && options.angular_error == 0.0;
  if (chosen.has_discrepancy || options.angular_error != 0.0) return chosen;
  if (options.keeps_all || !options.residuals.empty() || options.wants_uncertainty())
    gonio::refuse(
        "--no-reject, --residuals, --report, --uncertainty and --uncertainty-image need a discrepancy: they are not "
        "available with --discrepancy 0, --eta, or a solver other than tikhonov");
  if (options.discrepancy != 0.0 && options.discrepancy != reconstruct_options{}.discrepancy)
    gonio::refuse("--discrepancy is not available with --eta, or a solver other than tikhonov");
  return chosen;
}

/// Chooses Tikhonov's penalty, for use without --eta.
double chosen_eta(const reconstruct_options& options, const gonio::log_relative_pca& prior,
                  const gonio::sample_set& samples) {
  return options.noise ? gonio::eta_of_noise(prior, samples, *options.noise, options.threads)
                       : gonio::eta_of_unknown_noise(prior, samples, 0.3, options.threads);
}

}  // namespace

reconstruction reconstruct_by_components(const reconstruct_options& options, const gonio::sample_set& measured) {
  const auto [prior, solver, has_discrepancy, is_penalised] = choose_components(options);
  if (has_discrepancy) return reconstruct_with_discrepancy(options, prior, measured);
  const std::optional<gonio::sample_set> colours = colours_to_fit(options, measured);
  const gonio::sample_set& samples = colours ? *colours : measured;
  if (options.angular_error != 0.0) return reconstruct_misplaced(options, prior, samples);
  if (!is_penalised) return fit(prior, solver, samples, options);
  const double eta = chosen_eta(options, prior, samples);
  reconstruction result = fit(prior, gonio::tikhonov(eta), samples, options);
  result.details["eta"] = eta;
  result.sentence += ", eta " + fixed(eta, 3);
  return result;
}

reconstruction reconstruct_by_soft_or_specular(const reconstruct_options& options, const gonio::sample_set& samples) {
  const std::filesystem::path& file = options.materials.prior;
  if (options.materials.held_prior)
    gonio::refuse("--method soft-specular needs --prior as a file, written by gonio learn --split");
  if (is_shipped(file) || gonio::io::is_prior(file))
    gonio::refuse({"--method soft-specular needs a --prior written by gonio learn --split; ", file.native(),
                   " holds one prior of all materials"});
  const gonio::soft_specular_prior prior = gonio::io::read_soft_specular_prior(file);
  const std::string& stated = options.solver.eta;
  if (stated == "gcv" || stated == "loo")
    gonio::refuse("--method soft-specular needs a number for --eta, not " + stated);
  const auto penalties = gonio::penalties_in_proportion(prior, stated.empty() ? published_eta : number_of_eta(stated));
  // The contrast of the highlight in RGB chooses the prior.
  const auto chosen =
      gonio::soft_specular_decomposition(prior, penalties, options.threads).fit(samples.in_three_channels());
  const bool is_soft = chosen.kind() == gonio::material_kind::soft;
  const double eta = is_soft ? penalties.soft : penalties.specular;
  reconstruction result = fit(is_soft ? prior.soft() : prior.specular(), gonio::tikhonov(eta), samples, options);
  result.details["kind"] = is_soft ? "soft" : "specular";
  result.details["contrast"] = chosen.contrast();
  result.details["threshold"] = prior.threshold();
  result.details["eta"] = eta;
  result.sentence = std::string("classified as ") + (is_soft ? "soft" : "specular") + ": highlight contrast " +
                    fixed(chosen.contrast(), 2) + " (threshold " + fixed(prior.threshold(), 2) + "); " +
                    result.sentence;
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
  return options.fits_spectra ? fit(materials.as_grey(), solver, samples, options)
                              : fit(materials, solver, samples, options);
}

reconstruction reconstruct_by_radial_functions(const reconstruct_options& options, const gonio::sample_set& samples) {
  const gonio::valid_cells cells;
  const auto centres = gonio::farthest_point_centres(cells, gonio::published_centre_count, options.seed);
  const auto metric = chosen_metric(options, [&] { return prior_of(options.materials).metric().on(cells); });
  return fit(gonio::rbf<gonio::any_metric>{cells, metric, centres}, gonio::tikhonov{1e-6}, samples, options);
}

reconstruction reconstruct_by_pull_push(const reconstruct_options& options, const gonio::sample_set& samples) {
  return by_threes(options, samples, [&](const gonio::sample_set& colours) {
    return gonio::pull_push{gonio::valid_cells(), options.threads}.fit(colours).table();
  });
}

reconstruction reconstruct_by_neighbours(const reconstruct_options& options, const gonio::sample_set& samples) {
  reconstruction result = by_threes(options, samples, [&](const gonio::sample_set& colours) {
    const interpolated_samples f = interpolate(colours, {.neighbours = options.neighbours});
    return gonio::tabulate(f, gonio::valid_cells(), options.threads);
  });
  result.details["neighbours"] = options.neighbours;
  const Eigen::Index count = std::min(options.neighbours, std::ssize(samples));
  result.sentence += count == 1 ? "nearest sample in each direction"
                                : "mean of the nearest " + std::to_string(count) + " samples in each direction";
  return result;
}

}  // namespace cli
