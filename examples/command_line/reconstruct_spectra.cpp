/// gonio reconstruct --spectra: each wavelength as a grey material.

#include "fixed.hpp"
#include "progress_bar.hpp"
#include "reconstruct_methods.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/fitted_spectra.hpp>
#include <gonio/io/text.hpp>
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
  return described_spectra(fitted.tabulate(gonio::valid_cells(), options.threads), fitted.report(), spectra.size(),
                           options);
}

reconstruction by_components(const reconstruct_options& options, const gonio::spectral_samples& spectra,
                             const gonio::sample_set& colours) {
  const auto [prior, solver, has_discrepancy, is_penalised] = choose_components(options);
  if (has_discrepancy) return reconstruct_spectra_with_discrepancy(options, prior, spectra, colours);
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

}  // namespace

reconstruction described_spectra(gonio::spectral_table spectra, const gonio::solve_report& report, Eigen::Index samples,
                                 const reconstruct_options& options) {
  using gonio::io::detail::shortest;
  const gonio::illuminant light = options.reading.light.value_or(gonio::illuminant::d65);
  reconstruction result{spectra.colours(light, options.threads)};
  const std::vector<double>& wavelengths = spectra.wavelengths();
  const Eigen::VectorXd residual = report.residual / std::sqrt(static_cast<double>(samples));
  result.details = {{"wavelengths_nm", wavelengths},
                    {"mapped_residual_rms", listed(residual)},
                    {"kkt_residual", listed(report.kkt_residual)}};
  const bool is_one = wavelengths.size() == 1;
  if (!is_one) result.details["illuminant"] = light == gonio::illuminant::a ? "A" : "D65";
  result.sentence = is_one ? "one wavelength, " + shortest(wavelengths.front()) + " nm"
                           : std::to_string(wavelengths.size()) + " wavelengths from " + shortest(wavelengths.front()) +
                                 " to " + shortest(wavelengths.back()) + " nm";
  result.sentence += ", residual in the mapped domain (rms) " + fixed(residual.minCoeff(), 3) +
                     (is_one ? "" : " to " + fixed(residual.maxCoeff(), 3));
  result.spectra = std::move(spectra);
  return result;
}

reconstruction reconstruct_each_wavelength(const reconstruct_options& options, const gonio::spectral_samples& spectra,
                                           const gonio::sample_set& colours) {
  if (options.method == "pca") return by_components(options, spectra, colours);
  if (options.method == "linear") return by_materials(options, spectra);
  gonio::refuse("--spectra needs --method pca or linear: --method " + options.method + " fits colours");
}

}  // namespace cli
