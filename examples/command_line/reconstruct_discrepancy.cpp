/// gonio reconstruct --method pca: components and a discrepancy, and samples that the others contradict.

#include "fixed.hpp"
#include "measurement_files.hpp"
#include "measures_as_json.hpp"
#include "reconstruct_methods.hpp"
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/discrepancy_decomposition.hpp>
#include <gonio/estimate/fitted_spectra.hpp>
#include <gonio/estimate/posterior.hpp>
#include <gonio/estimate/screened_samples.hpp>
#include <gonio/io/file.hpp>
#include <gonio/io/sample_provenance.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <span>
#include <utility>

namespace cli {

namespace {

/// Of the green channel, which has most of the luminance: "sample 6 disagrees, left out: measured 2.09, the others say
/// 0.140 (0.110 to 0.170)".
std::string told(const gonio::outlying_sample& out, Eigen::Index number, const char* what_is_done) {
  const double low = out.predicted.y() * std::exp(-out.deviation), high = out.predicted.y() * std::exp(out.deviation);
  return "sample " + std::to_string(number + 1) + " disagrees, " + what_is_done + ": measured " +
         reflectance(out.measured.y()) + ", the others say " + reflectance(out.predicted.y()) + " (" +
         reflectance(low) + " to " + reflectance(high) + ", green)";
}

/// Of all samples that count: what was measured, what all others say, and by how much it is off. `numbers` are their
/// positions in the file.
std::vector<checked_sample> check_samples(const gonio::log_relative_pca& prior, const gonio::located_samples& located,
                                          const gonio::left_out_predictions& others,
                                          const std::vector<Eigen::Index>& numbers,
                                          const std::vector<Eigen::Index>& left_out) {
  std::vector<checked_sample> all(located.size());
  const Eigen::VectorXd disagreement = others.disagreement();
  for (Eigen::Index i = 0; i < located.size(); ++i) {
    const gonio::location& at = located.locations[i];
    const double offset = gonio::offset_at(prior, at);
    all[i] = {.number = numbers[i],
              .measured = located.values.row(i).transpose().array(),
              .others = {},
              .relative_deviation = std::expm1(others.deviation[i]),
              .disagreement = disagreement[i],
              .left_out = std::ranges::count(left_out, i) > 0};
    for (Eigen::Index c = 0; c < 3; ++c)
      all[i].others[c] = std::max(prior.metric().inverse(others.mean(i, c) + offset, at), 0.0);
  }
  return all;
}

/// docs/reference/formats.md has the columns.
void write_residuals(const reconstruct_options& options, const std::vector<checked_sample>& checked) {
  std::string text = gonio::io::comment_lines(options.provenance);
  text += "sample,r,g,b,others_r,others_g,others_b,relative_deviation,disagreement,left_out\n";
  for (const checked_sample& each : checked) {
    text += std::to_string(each.number + 1);
    const auto append = [&](double value) {
      std::array<char, 40> digits{};
      std::snprintf(digits.data(), digits.size(), ",%.6g", value);
      text += digits.data();
    };
    for (const double value : each.measured) append(value);
    for (const double value : each.others) append(value);
    append(each.relative_deviation);
    append(each.disagreement);
    text += each.left_out ? ",1\n" : ",0\n";
  }
  gonio::io::write_atomically(options.residuals, std::as_bytes(std::span(text)));
}

using known_values = gonio::posterior<gonio::log_relative>;

/// By how much, relative to it, a value is known with a probability of 68 %.
double known_to(const known_values& known, double deviation) {
  return std::expm1(known.deviations_of(gonio::confidence_level::sixty_eight_percent) * deviation);
}

/// "half of all directions are known to 6 %, half of those beyond 80 degrees to 40 %".
void describe(const known_values& known, const gonio::log_relative_pca& prior, const reconstruct_options& options,
              reconstruction& result) {
  const gonio::valid_cells coarse(gonio::grid({15, 9, 12}));
  const std::vector<double> all = known.deviations(coarse, options.threads);
  std::vector<double> grazing;
  const double limit = std::cos(gonio::radians(80.0));
  for (Eigen::Index cell = 0; cell < std::ssize(all); ++cell) {
    const gonio::cosine_pair cosine = gonio::cosines(coarse.angles(cell));
    if (std::min(cosine.i, cosine.o) < limit) grazing.push_back(all[cell]);
  }
  // A highlight that may be four times too bright or too dark is no result.
  const double factor = gonio::highlight_factor(known, prior.cells());
  result.details["highlight_known_to_factor"] = factor;
  if (factor > 4.0)
    result.warnings.push_back("the highlight is known to a factor of " + fixed(factor, factor < 10.0 ? 1 : 0) +
                              " only: measure more directions whose half vector is within 5 degrees of the normal");
  const double everywhere = known_to(known, gonio::median(std::vector(all))),
               there = known_to(known, gonio::median(grazing));
  result.details["known_to"] = everywhere;
  result.details["known_to_beyond_80_degrees"] = there;
  result.sentence += "; half of all directions are known to " + fixed(100.0 * everywhere, 0) +
                     " %, half of those beyond 80 degrees to " + fixed(100.0 * there, 0) + " %";
}

/// The relative deviation in all directions as a table, the same in all channels.
gonio::brdf_table uncertainty_table(const known_values& known, gonio::thread_count threads) {
  gonio::brdf_table coarse(gonio::valid_cells(gonio::grid({30, 15, 18})));
  const std::vector<double> all = known.deviations(coarse.cells(), threads);
  for (Eigen::Index cell = 0; cell < std::ssize(all); ++cell)
    coarse.set(cell, gonio::rgb::Constant(known_to(known, all[cell])));
  return gonio::resample(coarse, gonio::valid_cells(), threads);
}

using discrepancy_estimator = gonio::discrepancy_decomposition<gonio::log_relative>;

/// What was found about the samples; `numbers` are their positions in the file.
void describe(const gonio::screened_samples& screened, Eigen::Index samples, const std::vector<Eigen::Index>& numbers,
              reconstruction& result) {
  if (samples >= gonio::fewest_weighed) {
    result.details["outliers"] = screened.outlier_share;
    result.details["down_weighted"] = static_cast<double>(screened.left_out.size()) / static_cast<double>(samples);
    result.sentence += ", about " + fixed(100.0 * screened.outlier_share, 1) + " % outliers";
    return;
  }
  const bool leaves_out = samples >= gonio::fewest_left_out;
  json contradicted = json::array();
  for (const gonio::outlying_sample& out : screened.contradicted) {
    result.warnings.push_back(told(out, numbers[out.number], leaves_out ? "left out" : "kept beside so few"));
    contradicted.push_back({{"sample", numbers[out.number] + 1},
                            {"measured", per_channel(out.measured)},
                            {"others", per_channel(out.predicted)},
                            {"mapped_deviation", out.deviation},
                            {"probability_wrong", out.probability}});
  }
  result.details[leaves_out ? "left_out" : "disagreeing"] = contradicted;
}

/// The colours of samples fitted, without those that the others contradict.
reconstruction fit_colours(const discrepancy_estimator& estimator, const gonio::screened_samples& screened,
                           const reconstruct_options& options) {
  const auto fitted = estimator.fit_located(screened.kept);
  reconstruction result{fitted.tabulate(gonio::valid_cells(), options.threads)};
  const gonio::rgb residual = fitted.report()->residual.array() / std::sqrt(static_cast<double>(screened.kept.size()));
  result.details = {{"mapped_residual_rms", per_channel(residual)},
                    {"kkt_residual", per_channel(fitted.report()->kkt_residual.array())}};
  result.sentence = "residual in the mapped domain (rms) " + fixed(residual.x(), 3) + ' ' + fixed(residual.y(), 3) +
                    ' ' + fixed(residual.z(), 3);
  return result;
}

/// What makes a fit of the samples that are kept.
using fit_function = std::function<reconstruction(const discrepancy_estimator&, const gonio::screened_samples&)>;

reconstruction reconstruct_by(const fit_function& fit, const reconstruct_options& options,
                              const gonio::log_relative_pca& prior, const gonio::sample_set& samples) {
  const gonio::discrepancy_model model{.variance = options.discrepancy, .noise = options.noise.value_or(0.0)};
  const discrepancy_estimator estimator{prior, model, options.threads};
  const gonio::located_samples located = gonio::locate_samples(prior.cells(), samples, options.threads);
  const std::vector<Eigen::Index> numbers = counting_samples(samples);
  if (!options.residuals.empty() && located.size() > most_residuals)
    gonio::refuse("--residuals needs at most " + std::to_string(most_residuals) + " samples, not " +
                  std::to_string(located.size()));

  // Find out which samples the others contradict.
  gonio::screened_samples screened{located};
  if (!options.keeps_all) screened = gonio::screen(estimator, located, options.threads);
  std::vector<checked_sample> checked;
  if (!options.residuals.empty() || (options.tells_residuals() && located.size() <= most_residuals))
    checked = check_samples(prior, located,
                            gonio::predict_left_out(estimator.covariance(located), estimator.mapped_values(located)),
                            numbers, screened.left_out);
  if (!options.residuals.empty()) write_residuals(options, checked);

  // Fit the rest.
  reconstruction result = fit(estimator, screened);
  result.checked = std::move(checked);
  for (const Eigen::Index i : screened.left_out) result.left_out.push_back(numbers[i]);
  result.details["discrepancy"] = options.discrepancy;
  if (!options.keeps_all) describe(screened, located.size(), numbers, result);
  const gonio::posterior known(estimator, screened.kept);
  describe(known, prior, options, result);
  if (options.wants_uncertainty()) result.uncertainty = uncertainty_table(known, options.threads);
  return result;
}

}  // namespace

reconstruction reconstruct_with_discrepancy(const reconstruct_options& options, const gonio::log_relative_pca& prior,
                                            const gonio::sample_set& samples) {
  const auto fit = [&](const discrepancy_estimator& estimator, const gonio::screened_samples& screened) {
    return fit_colours(estimator, screened, options);
  };
  return reconstruct_by(fit, options, prior, samples);
}

reconstruction reconstruct_spectra_with_discrepancy(const reconstruct_options& options,
                                                    const gonio::log_relative_pca& prior,
                                                    const gonio::spectral_samples& spectra,
                                                    const gonio::sample_set& samples) {
  const auto fit = [&](const discrepancy_estimator& estimator, const gonio::screened_samples& screened) {
    gonio::located_samples located = gonio::locate_samples(prior.cells(), spectra, options.threads);
    if (!options.keeps_all)
      located = gonio::robust_decomposition<gonio::log_relative>::weighted(std::move(located), screened.inlier_weights);
    const Eigen::Index count = located.size();
    auto [functions, found] = estimator.solve_located(std::move(located));
    const gonio::fitted_spectra fitted(spectra.wavelengths, std::move(functions), std::move(found));
    reconstruction result = described_spectra(fitted.tabulate(gonio::valid_cells(), options.threads), options);
    describe_residuals(fitted.report(), count, result);
    return result;
  };
  return reconstruct_by(fit, options, prior, samples);
}

}  // namespace cli
