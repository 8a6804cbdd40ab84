/// gonio reconstruct --method robust: components and a discrepancy of the samples that are no outliers.

#include "fixed.hpp"
#include "measures_as_json.hpp"
#include "reconstruct_methods.hpp"
#include <gonio/estimate/robust_decomposition.hpp>
#include <gonio/io/prior.hpp>

#include <cmath>

namespace cli {

reconstruction reconstruct_robustly(const reconstruct_options& options, const gonio::sample_set& samples) {
  const auto prior = gonio::io::read_prior(options.materials.prior);
  const gonio::located_samples located = gonio::locate_samples(prior.cells(), samples, options.threads);
  if (gonio::largest_outlier_share(located.size()) == 0.0) {
    reconstruction result = reconstruct_with_discrepancy(options, prior, samples);
    result.cautions = "warning: " + std::to_string(located.size()) +
                      " samples are too few to tell outliers from highlights: --method pca was taken\n";
    return result;
  }
  // Weigh the samples, and fit those that are no outliers.
  const gonio::discrepancy_model model{.variance = options.discrepancy, .noise = options.noise.value_or(0.0)};
  const gonio::discrepancy_decomposition both{prior, model, options.threads};
  const gonio::robust_decomposition robust{both, {.seed = options.seed}, options.threads};
  const Eigen::VectorXd weights = robust.inlier_weights(located);
  const auto fitted = both.fit_located(robust.weighted(located, weights));
  reconstruction result{fitted.tabulate(gonio::valid_cells(), options.threads)};
  // Describe the fit.
  const auto n = static_cast<double>(located.size());
  const double outliers = 1.0 - weights.sum() / n;
  const double down_weighted = static_cast<double>((weights.array() < 0.5).count()) / n;
  const gonio::rgb residual = fitted.report()->residual.array() / std::sqrt(n);
  result.details = {{"mapped_residual_rms", per_channel(residual)},
                    {"kkt_residual", per_channel(fitted.report()->kkt_residual.array())},
                    {"outliers", outliers},
                    {"largest_outlier_share", gonio::largest_outlier_share(located.size())},
                    {"down_weighted", down_weighted}};
  result.sentence = "residual in the mapped domain (rms) " + fixed(residual.x(), 3) + ' ' + fixed(residual.y(), 3) +
                    ' ' + fixed(residual.z(), 3) + ", about " + fixed(100.0 * outliers, 1) + " % outliers (" +
                    fixed(100.0 * gonio::largest_outlier_share(located.size()), 0) + " % at most from so few)";
  if (located.size() >= 1000) result.sentence.erase(result.sentence.rfind(" ("));
  return result;
}

}  // namespace cli
