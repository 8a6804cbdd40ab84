/// gonio reconstruct --spectra: each wavelength as a grey material.

#include "reconstruct_methods.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/fitted_spectra.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace cli {

namespace {

json listed(const Eigen::VectorXd& numbers) {
  json all = json::array();
  for (const double number : numbers) all.push_back(number);
  return all;
}

template <class Estimator>
reconstruction fit(const Estimator& estimator, const gonio::spectral_samples& spectra,
                   const reconstruct_options& options) {
  const auto fitted = gonio::fit_spectra(estimator, spectra, options.threads);
  reconstruction result = described_spectra(fitted.tabulate(gonio::valid_cells(), options.threads), options);
  describe_residuals(fitted.report(), spectra.size(), result);
  return result;
}

reconstruction by_components(const reconstruct_options& options, const gonio::spectral_samples& spectra,
                             const gonio::sample_set& colours) {
  const auto [prior, solver, has_discrepancy, is_penalised] = choose_components(options);
  if (has_discrepancy) return reconstruct_spectra_with_discrepancy(options, prior, spectra);
  if (options.angular_error != 0.0)
    gonio::refuse("--misplaced fits colours: leave out --spectra, or state no misplacement");
  if (!is_penalised) return fit(gonio::decomposition{prior, solver, options.threads}, spectra, options);
  const double eta = chosen_eta(options, prior, colours);
  reconstruction result = fit(gonio::decomposition{prior, gonio::tikhonov(eta), options.threads}, spectra, options);
  result.details["eta"] = eta;
  result.sentence += ", eta " + fixed(eta, 3);
  return result;
}

reconstruction by_materials(const reconstruct_options& options, const gonio::spectral_samples& spectra) {
  const auto solver = make_solver(options.solver, {"nnls", "gcv"});
  progress_bar bar;
  const auto materials = chosen_materials(options, bar.listener()).as_grey();
  bar.wipe();
  return fit(gonio::decomposition{materials, solver, options.threads}, spectra, options);
}

reconstruction by_soft_or_specular(const reconstruct_options& options, const gonio::spectral_samples& spectra,
                                   const gonio::sample_set& colours) {
  const soft_specular_choice choice = choose_soft_or_specular(options, colours);
  const gonio::tikhonov solver(choice.eta());
  reconstruction result = fit(gonio::decomposition{choice.components(), solver, options.threads}, spectra, options);
  describe(choice, result);
  return result;
}

/// By a method that treats channels alike and apart: three wavelengths at a time take the places of red, green, blue.
reconstruction by_threes(const reconstruct_options& options, const gonio::spectral_samples& spectra,
                         reconstruction (*method)(const reconstruct_options&, const gonio::sample_set&)) {
  gonio::spectral_table table(gonio::valid_cells(), spectra.wavelengths);
  gonio::sample_set three = spectra.at_wavelength(0);
  reconstruction last{gonio::brdf_table(table.cells())};
  for (Eigen::Index first = 0; first < spectra.bands(); first += 3) {
    const Eigen::Index count = std::min<Eigen::Index>(3, spectra.bands() - first);
    for (Eigen::Index i = 0; i < spectra.size(); ++i)
      for (Eigen::Index c = 0; c < 3; ++c)
        three[i].value[c] = double{spectra.values(i, first + std::min(c, count - 1))};
    last = method(options, three);
    for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
      for (Eigen::Index c = 0; c < count; ++c) table.values()(cell, first + c) = last.table.values()[3 * cell + c];
  }
  reconstruction result = described_spectra(std::move(table), options);
  result.details.update(last.details);
  if (!last.sentence.empty()) result.sentence += ", " + last.sentence;
  return result;
}

}  // namespace

reconstruction described_spectra(gonio::spectral_table spectra, const reconstruct_options& options) {
  using gonio::io::shortest;
  const gonio::illuminant light = options.reading.light.value_or(gonio::illuminant::d65);
  const std::vector<double>& wavelengths = spectra.wavelengths();
  const bool has_colours = wavelengths.size() == 1 || std::ranges::any_of(wavelengths, gonio::is_visible);
  if (!has_colours && !options.holds_spectra_alone())
    gonio::refuse(
        "none of the wavelengths is visible, so that there is no colour to write or to draw: give -o FILE.bsdf "
        "alone, which holds the wavelengths");
  reconstruction result{has_colours ? spectra.colours(light, options.threads)
                                    : gonio::brdf_table(gonio::valid_cells(gonio::grid({1, 1, 1})))};
  result.details = {{"wavelengths_nm", wavelengths}};
  const bool is_one = wavelengths.size() == 1;
  if (!is_one) result.details["illuminant"] = light == gonio::illuminant::a ? "A" : "D65";
  result.sentence = is_one ? "one wavelength, " + shortest(wavelengths.front()) + " nm"
                           : std::to_string(wavelengths.size()) + " wavelengths from " + shortest(wavelengths.front()) +
                                 " to " + shortest(wavelengths.back()) + " nm";
  result.spectra = std::move(spectra);
  return result;
}

void describe_residuals(const gonio::solve_report& report, Eigen::Index samples, reconstruction& result) {
  const Eigen::VectorXd residual = report.residual / std::sqrt(static_cast<double>(samples));
  result.details["mapped_residual_rms"] = listed(residual);
  result.details["kkt_residual"] = listed(report.kkt_residual);
  result.sentence += ", residual in the mapped domain (rms) " + fixed(residual.minCoeff(), 3) +
                     (residual.size() == 1 ? "" : " to " + fixed(residual.maxCoeff(), 3));
}

reconstruction reconstruct_each_wavelength(const reconstruct_options& options, const gonio::spectral_samples& spectra,
                                           const gonio::sample_set& colours) {
  if (options.method == "pca") return by_components(options, spectra, colours);
  if (options.method == "linear") return by_materials(options, spectra);
  if (options.method == "soft-specular") return by_soft_or_specular(options, spectra, colours);
  if (options.method == "rbf")
    return fit(gonio::decomposition{chosen_radial_functions(options), radial_solver, options.threads}, spectra,
               options);
  if (options.method == "pull-push") return by_threes(options, spectra, reconstruct_by_pull_push);
  if (options.method == "scattered") return by_threes(options, spectra, reconstruct_by_neighbours);
  gonio::refuse("--spectra needs another --method: " + options.method + " weighs samples by their colours");
}

}  // namespace cli
