/// gonio reconstruct --method pca: describes the result of the library's `reconstruction` for people.

#include "reconstruct_methods.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/pages/elapsed_time.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/measures_as_json.hpp"
#include "tool/pages/sample_warnings.hpp"
#include <gonio/estimate/angular_error.hpp>
#include <gonio/estimate/errors_in_variables_decomposition.hpp>
#include <gonio/estimate/eta_of_noise.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/sample_provenance.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>

namespace cli {

namespace {

using reconstructed_brdf = gonio::reconstructed<gonio::log_relative>;

/// Describes an outlier by the channel that disagrees most: "sample 6 disagrees and is left out: measured 2.09, the
/// others say 0.140 (0.110 to 0.170, red)".
std::string told(const gonio::outlying_sample& out, const std::string& what_is_done) {
  const Eigen::Index channel = out.worst_channel();
  const double predicted = out.predicted[channel];
  return "sample " + std::to_string(out.number + 1) + " disagrees and " + what_is_done + ": measured " +
         reflectance(out.measured[channel]) + ", the others say " + reflectance(predicted) + " (" +
         reflectance(predicted * std::exp(-out.deviation)) + " to " + reflectance(predicted * std::exp(out.deviation)) +
         (is_grey(out.measured) ? "" : ", " + out.channel_names[channel]) + ")";
}

/// docs/reference/formats.md describes the columns.
void write_residuals(const reconstruct_options& options, const std::vector<gonio::sample_residual>& residuals) {
  std::string text = gonio::io::comment_lines(options.provenance);
  text += "sample,r,g,b,others_r,others_g,others_b,relative_deviation,disagreement,left_out\n";
  for (const gonio::sample_residual& each : residuals) {
    text += std::to_string(each.number + 1);
    const auto append = [&](double value) {
      std::array<char, 40> digits{};
      std::snprintf(digits.data(), digits.size(), ",%.6g", value);
      text += digits.data();
    };
    for (const double value : each.measured) append(value);
    for (const double value : each.predicted) append(value);
    append(each.relative_deviation);
    append(each.disagreement);
    text += each.rejected ? ",1\n" : ",0\n";
  }
  gonio::io::write_atomically(options.residuals, std::as_bytes(std::span(text)));
}

/// Adds "half of all directions are known to 6 %, half of the directions more than 80 degrees from the normal are known
/// to 40 %".
void describe(const gonio::certainty& known, reconstruction& result) {
  // A highlight uncertain by a factor of more than four needs a warning.
  const double factor = known.highlight_factor;
  result.details["highlight_known_to_factor"] = factor;
  constexpr double unknown = 100.0;
  const std::string how_well =
      factor > unknown ? "is not known" : "is known to a factor of " + fixed(factor, factor < 10.0 ? 1 : 0) + " only";
  if (factor > 4.0)
    result.warnings.push_back("the highlight " + how_well +
                              ": measure more directions whose half vector is within 5 degrees of the normal");
  if (known.known_to_outside > 0.0) {
    constexpr double rounding = 0.01;  // degrees
    const auto farthest = std::max(std::lround(std::ceil(gonio::degrees(known.measured_to) - rounding)), 1L);
    result.warnings.push_back("the half vectors of all samples are within " + counted(farthest, "degree") +
                              " of the normal: farther away, half of all directions are " +
                              known_to(known.known_to_outside));
    result.details["known_to_outside_the_samples"] = known.known_to_outside;
  }
  result.details["known_to"] = known.known_to;
  result.details["known_to_beyond_80_degrees"] = known.known_to_at_grazing;
  result.sentence += "; half of all directions are " + known_to(known.known_to) +
                     ", half of the directions more than 80 degrees from the normal are " +
                     known_to(known.known_to_at_grazing);
}

/// Returns the relative deviation in all directions as a table, the same in all channels.
gonio::brdf_table uncertainty_table(const reconstructed_brdf& paint, gonio::thread_count threads) {
  gonio::brdf_table coarse(gonio::valid_cells(gonio::grid({30, 15, 18})));
  const std::vector<double> all = paint.known_to(coarse.cells());
  for (Eigen::Index cell = 0; cell < std::ssize(all); ++cell) coarse.set(cell, gonio::rgb::Constant(all[cell]));
  return gonio::resample(coarse, gonio::valid_cells(), threads);
}

/// Describes the values of spectra that were replaced: "sample 8 at 520 nm: measured 0.420, but its neighbours and the
/// other samples say 0.081, which replaces it".
void describe_spikes(const std::vector<gonio::spectral_spike>& spikes, const gonio::channels& measured,
                     reconstruction& result) {
  constexpr std::size_t most_told = 20;
  json replaced = json::array();
  for (const gonio::spectral_spike& each : spikes) {
    if (replaced.size() < most_told)
      result.warnings.push_back("sample " + std::to_string(each.number + 1) + " at " + measured.name(each.channel) +
                                ": measured " + reflectance(each.measured) +
                                ", but its neighbours and the other samples say " + reflectance(each.replaced_by) +
                                ", which replaces it");
    replaced.push_back({{"sample", each.number + 1},
                        {"wavelength", measured.wavelengths()[each.channel]},
                        {"measured", each.measured},
                        {"replaced_by", each.replaced_by},
                        {"probability_wrong", each.probability}});
  }
  if (spikes.size() > most_told)
    result.warnings.push_back(std::to_string(spikes.size() - most_told) +
                              " more values of single wavelengths are replaced (--json lists them)");
  if (measured.are_wavelengths()) result.details["replaced"] = replaced;
}

/// Describes the rejected samples; `samples` is the number with nonzero weight.
void describe_rejected(const reconstructed_brdf& paint, Eigen::Index samples, reconstruction& result) {
  json contradicted = json::array();
  for (const gonio::outlying_sample& out : paint.contradicted()) {
    const double weight = gonio::inlier_weight(out.probability);
    result.warnings.push_back(told(out, weight < gonio::inliers::least_weight
                                            ? "is left out"
                                            : "has " + fixed(100.0 * weight, 0) + " % of its weight"));
    contradicted.push_back(
        {{"sample", out.number + 1},
         {"channels", json::array({out.channel_names[0], out.channel_names[1], out.channel_names[2]})},
         {"measured", per_channel(out.measured)},
         {"others", per_channel(out.predicted)},
         {"mapped_deviation", out.deviation},
         {"probability_wrong", out.probability}});
  }
  const auto unnamed = std::ssize(paint.rejected()) - std::ssize(paint.contradicted());
  if (unnamed > 0)
    result.warnings.push_back(std::to_string(unnamed) +
                              (unnamed == 1 ? " more sample disagrees and has less than a tenth of its weight"
                                            : " more samples disagree and have less than a tenth of their weight") +
                              (samples <= most_residuals ? " (--residuals lists them)" : ""));
  const auto rejected = std::ssize(paint.rejected());
  if (rejected >= 2 && 10 * rejected > samples)
    result.warnings.push_back(std::to_string(rejected) + " of " + std::to_string(samples) +
                              " samples disagree with the others. If they have something in common, the "
                              "disagreement may be a property of the material rather than an error (--no-reject "
                              "keeps these samples)");
  result.details["left_out"] = contradicted;
  result.details["outliers"] = paint.outlier_share();
  result.details["down_weighted"] = static_cast<double>(paint.rejected().size()) / static_cast<double>(samples);
  if (paint.outlier_share() >= 0.0005)
    result.sentence += ", about " + fixed(100.0 * paint.outlier_share(), 1) + " % outliers";
}

gonio::reconstruction<gonio::log_relative> estimator_of(const reconstruct_options& options,
                                                        const gonio::log_relative_pca& prior, Eigen::Index samples) {
  if (!options.residuals.empty() && samples > most_residuals)
    gonio::refuse("--residuals needs at most " + std::to_string(most_residuals) + " samples, not " +
                  std::to_string(samples));
  const gonio::reconstruction estimator{
      prior, {.variance = options.discrepancy, .noise = options.noise.value_or(0.0)}, options.threads};
  return options.keeps_all ? estimator.keeping_all() : estimator;
}

/// Returns the samples with nonzero weight, whose weights are multiplied by the inlier weights.
gonio::sample_set as_much_as_they_count(const gonio::sample_set& samples, const std::vector<Eigen::Index>& counting,
                                        const Eigen::VectorXd& inlier_weights) {
  gonio::sample_set agreeing(samples.channels());
  for (std::size_t k = 0; k < counting.size(); ++k) {
    const Eigen::Index i = counting[k];
    agreeing.add(samples.directions(i), samples.values(i),
                 gonio::rgb(inlier_weights[static_cast<Eigen::Index>(k)] * samples.weight(i).of_each()));
  }
  return agreeing;
}

/// Adds residuals, rejected samples and uncertainty to the result.
reconstruction described(reconstruction result, const reconstructed_brdf& paint, Eigen::Index samples,
                         const reconstruct_options& options) {
  if (!options.residuals.empty() || (options.tells_residuals() && samples <= most_residuals))
    result.residuals = paint.residuals();
  if (!options.residuals.empty()) write_residuals(options, result.residuals);
  result.rejected = paint.rejected();
  if (!options.keeps_all) describe_rejected(paint, samples, result);
  describe(paint.certainty(), result);
  if (options.wants_uncertainty()) result.uncertainty = uncertainty_table(paint, options.threads);
  return result;
}

}  // namespace

reconstruction reconstruct_with_discrepancy(const reconstruct_options& options, const gonio::log_relative_pca& prior,
                                            const gonio::sample_set& samples) {
  const elapsed_time waiting("reconstructing");
  const Eigen::Index count = std::ssize(gonio::counting_positions(samples));
  const auto estimator = estimator_of(options, prior, count);
  const bool converts = !options.fits_spectra && samples.channels().are_wavelengths();
  std::vector<gonio::spectral_spike> spikes;
  const auto fit_colours = [&] {
    gonio::sample_set right = samples;
    spikes = estimator.replace_spikes(right);
    return estimator.fit(right.colours());
  };
  const auto paint = converts ? fit_colours() : estimator.fit(samples);
  reconstruction result =
      options.fits_spectra ? described_spectra(paint.tabulate_spectra(options.cells_of_spectra(prior.cells())), options)
                           : reconstruction{paint.tabulate(gonio::valid_cells())};
  describe_residuals(*paint.fit().report(), paint.kept(), result);
  result.details["discrepancy"] = options.discrepancy;
  describe_spikes(converts ? spikes : paint.spikes(), samples.channels(), result);
  return described(std::move(result), paint, count, options);
}

reconstruction reconstruct_misplaced(const reconstruct_options& options, const gonio::log_relative_pca& prior,
                                     const gonio::sample_set& samples) {
  const std::string& stated = options.solver.eta;
  const elapsed_time waiting("reconstructing");
  if ((!options.solver.name.empty() && options.solver.name != "tikhonov") || stated == "gcv" || stated == "loo")
    gonio::refuse("--misplaced needs --solver tikhonov, and --noise or a number for --eta");
  // A reconstruction that knows the angular error gives the uncertainty and the disagreeing samples.
  const double angle = gonio::radians(options.angular_error);
  const std::vector<Eigen::Index> counting = gonio::counting_positions(samples);
  const auto estimator = estimator_of(options, prior, std::ssize(counting));
  const auto known =
      estimator.fit(gonio::weighted_by_angular_error(samples.through({}), prior, estimator.model(), angle));
  const gonio::sample_set agreeing = as_much_as_they_count(samples, counting, known.inlier_weights());
  const double eta = stated.empty() ? gonio::eta_of_noise(prior, agreeing, options.noise.value_or(0.0), options.threads)
                                    : number_of_eta(stated);
  const auto fitted = gonio::errors_in_variables_decomposition{prior, eta, angle, options.threads}.fit(agreeing);
  reconstruction result = tabulated(fitted, options);
  describe_residuals(*fitted.report(), known.kept(), result);
  result.details["eta"] = eta;
  return described(std::move(result), known, std::ssize(counting), options);
}

}  // namespace cli
