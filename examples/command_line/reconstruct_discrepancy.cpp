/// gonio reconstruct --method pca: components and a discrepancy, and samples that the others contradict.

#include "fixed.hpp"
#include "measures_as_json.hpp"
#include "reconstruct_methods.hpp"
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/discrepancy_decomposition.hpp>
#include <gonio/estimate/outlying_samples.hpp>
#include <gonio/estimate/posterior.hpp>
#include <gonio/estimate/robust_decomposition.hpp>
#include <gonio/io/file.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

namespace cli {

namespace {

/// Of fewer samples none is left out: one that disagrees may be the only one in the highlight. From `fewest_weighed`
/// samples on outliers count less, and are not named. docs/results/real-materials.md, real-methods.md.
constexpr Eigen::Index fewest_left_out = 13, fewest_weighed = 100;

/// What all others say of each sample is told of so many.
constexpr Eigen::Index most_residuals = 1000;

/// Which samples of the file count, by their positions.
std::vector<Eigen::Index> counting(const gonio::sample_set& samples) {
  std::vector<Eigen::Index> numbers;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i)
    if (samples[i].weight.counts()) numbers.push_back(i);
  return numbers;
}

/// Three or four digits: more are not known.
std::string reflectance(double value) { return fixed(value, value < 0.1 ? 4 : value < 10.0 ? 3 : 1); }

/// Of the green channel, which has most of the luminance: "sample 6 disagrees, left out: measured 2.09, the others say
/// 0.140 (0.110 to 0.170)".
std::string told(const gonio::outlying_sample& out, Eigen::Index number, const char* what_is_done) {
  const double low = out.predicted.y() * std::exp(-out.deviation), high = out.predicted.y() * std::exp(out.deviation);
  return "sample " + std::to_string(number + 1) + " disagrees, " + what_is_done + ": measured " +
         reflectance(out.measured.y()) + ", the others say " + reflectance(out.predicted.y()) + " (" +
         reflectance(low) + " to " + reflectance(high) + ", green)";
}

/// Of all samples that count: what was measured, what all others say, and by how much it is off.
void write_residuals(const std::filesystem::path& path, const gonio::log_relative_pca& prior,
                     const gonio::located_samples& located, const gonio::left_out_predictions& others,
                     const std::vector<Eigen::Index>& numbers, const std::vector<bool>& left_out) {
  std::string text = "sample,r,g,b,others_r,others_g,others_b,relative_deviation,disagreement,left_out\n";
  const Eigen::VectorXd disagreement = others.disagreement();
  for (Eigen::Index i = 0; i < located.size(); ++i) {
    const gonio::location& at = located.locations[i];
    const double offset = gonio::offset_at(prior, at);
    text += std::to_string(numbers[i] + 1);
    const auto append = [&](double value) {
      std::array<char, 40> digits{};
      std::snprintf(digits.data(), digits.size(), ",%.6g", value);
      text += digits.data();
    };
    for (Eigen::Index c = 0; c < 3; ++c) append(located.values(i, c));
    for (Eigen::Index c = 0; c < 3; ++c) append(std::max(prior.metric().inverse(others.mean(i, c) + offset, at), 0.0));
    append(std::expm1(others.deviation[i]));
    append(disagreement[i]);
    text += left_out[i] ? ",1\n" : ",0\n";
  }
  gonio::io::write_atomically(path, std::as_bytes(std::span(text)));
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

/// Samples that count as much as the others allow, and what is told of those that count less.
struct accepted_samples {
  gonio::located_samples located;
  std::vector<bool> is_left_out;  ///< of those that were given
  json details = json::object();
  std::string sentence{};
  std::vector<std::string> warnings{};
};

/// Of few samples: those that the others contradict are named, and left out unless samples are very few. `numbers` are
/// their positions in the file.
accepted_samples without_contradicted(const discrepancy_estimator& estimator, const gonio::located_samples& located,
                                      const std::vector<Eigen::Index>& numbers) {
  const gonio::sorted_samples sorted = gonio::reject_outlying(estimator, located);
  const bool leaves_out = located.size() >= fewest_left_out;
  accepted_samples result{leaves_out ? located.subset(sorted.kept) : located, std::vector<bool>(located.size(), false)};
  json disagreeing = json::array();
  for (const gonio::outlying_sample& out : sorted.left_out) {
    result.is_left_out[out.number] = leaves_out;
    result.warnings.push_back(told(out, numbers[out.number], leaves_out ? "left out" : "kept beside so few"));
    disagreeing.push_back({{"sample", numbers[out.number] + 1},
                           {"measured", per_channel(out.measured)},
                           {"others", per_channel(out.predicted)},
                           {"mapped_deviation", out.deviation},
                           {"probability_wrong", out.probability}});
  }
  result.details[leaves_out ? "left_out" : "disagreeing"] = disagreeing;
  return result;
}

/// Of many samples: outliers count less.
accepted_samples weighed_by_inliers(const discrepancy_estimator& estimator, const gonio::located_samples& located,
                                    gonio::thread_count threads) {
  const gonio::robust_decomposition robust{estimator, {}, threads};
  const Eigen::VectorXd weights = robust.inlier_weights(located);
  accepted_samples result{robust.weighted(located, weights), std::vector<bool>(located.size(), false)};
  for (Eigen::Index i = 0; i < weights.size(); ++i) result.is_left_out[i] = weights[i] < 0.5;
  const auto n = static_cast<double>(located.size());
  const double outliers = 1.0 - weights.sum() / n;
  result.details = {{"outliers", outliers},
                    {"down_weighted", static_cast<double>((weights.array() < 0.5).count()) / n}};
  result.sentence = ", about " + fixed(100.0 * outliers, 1) + " % outliers";
  return result;
}

accepted_samples accept(const reconstruct_options& options, const discrepancy_estimator& estimator,
                        const gonio::located_samples& located, const std::vector<Eigen::Index>& numbers) {
  if (options.keeps_all) return {located, std::vector<bool>(located.size(), false)};
  if (located.size() < fewest_weighed) return without_contradicted(estimator, located, numbers);
  return weighed_by_inliers(estimator, located, options.threads);
}

}  // namespace

reconstruction reconstruct_with_discrepancy(const reconstruct_options& options, const gonio::log_relative_pca& prior,
                                            const gonio::sample_set& samples) {
  const gonio::discrepancy_model model{.variance = options.discrepancy, .noise = options.noise.value_or(0.0)};
  const discrepancy_estimator estimator{prior, model, options.threads};
  const gonio::located_samples located = gonio::locate_samples(prior.cells(), samples, options.threads);
  const std::vector<Eigen::Index> numbers = counting(samples);
  if (!options.residuals.empty() && located.size() > most_residuals)
    gonio::refuse("--residuals needs at most " + std::to_string(most_residuals) + " samples, not " +
                  std::to_string(located.size()));

  // Find out which samples the others contradict.
  accepted_samples accepted = accept(options, estimator, located, numbers);
  if (!options.residuals.empty())
    write_residuals(options.residuals, prior, located,
                    gonio::predict_left_out(estimator.covariance(located), estimator.mapped_values(located)), numbers,
                    accepted.is_left_out);

  // Fit the rest.
  const auto fitted = estimator.fit_located(accepted.located);
  reconstruction result{fitted.tabulate(gonio::valid_cells(), options.threads)};
  const gonio::rgb residual =
      fitted.report()->residual.array() / std::sqrt(static_cast<double>(accepted.located.size()));
  result.details = {{"mapped_residual_rms", per_channel(residual)},
                    {"kkt_residual", per_channel(fitted.report()->kkt_residual.array())},
                    {"discrepancy", options.discrepancy}};
  result.details.update(accepted.details);
  result.sentence = "residual in the mapped domain (rms) " + fixed(residual.x(), 3) + ' ' + fixed(residual.y(), 3) +
                    ' ' + fixed(residual.z(), 3) + accepted.sentence;
  result.warnings = std::move(accepted.warnings);
  const gonio::posterior known(estimator, accepted.located);
  describe(known, prior, options, result);
  if (!options.uncertainty.empty() || !options.uncertainty_image.empty())
    result.uncertainty = uncertainty_table(known, options.threads);
  return result;
}

}  // namespace cli
