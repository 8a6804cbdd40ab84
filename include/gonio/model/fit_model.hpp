#pragma once
/// Fits sums of lobes to measurements.
/// J. B. Nielsen, J. R. Frisvad, K. Conradsen and H. Aanaes, "Addressing Grazing Angle Reflections in Phong Models",
/// SIGGRAPH Asia 2014 posters (consecutive optimisation, L1 norm); G. H. Golub and V. Pereyra, "The Differentiation of
/// Pseudo-Inverses and Nonlinear Least Squares Problems Whose Variables Separate", 1973, and L. Kaufman, "A Variable
/// Projection Method for Solving Separable Nonlinear Least Squares Problems", 1975 (colours are solved for exactly).

#include <gonio/model/model_loss.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// A fitted model and what is known of its minimum.
struct model_fit {
  analytic_brdf model;
  double loss = 0.0;  ///< the weighted mean over measurements and channels of the norm of the residual
  std::size_t evaluations = 0;
  bool converged = false;
  double promised_gain = 0.0;  ///< see `local_minimum`
};

namespace detail {

/// Where the fit of some lobes starts. Lobes of the same kind must not start alike, or they stay alike: the second is
/// four times as rough or sharp as the first, the third a fourth, and so on in turns.
[[nodiscard]] std::vector<lobe_kind::values> typical_shapes(const std::vector<const lobe_kind*>& kinds);

/// Descends over everything, from shapes and the colours that suit them.
template <class Metric>
[[nodiscard]] std::pair<Eigen::VectorXd, local_minimum> fit_from(const model_loss<Metric>& loss,
                                                                 const Eigen::VectorXd& shapes,
                                                                 const model_fit_options& options) {
  const unknown_bounds box = loss.bounds();
  levenberg_marquardt_options descent{.iteration_limit = options.iteration_limit};
  // Weighted squares approach the minimum of another norm by a share of the way at a time.
  if (options.norm != fit_norm::l2) descent.smallest_gain = 1e-10;
  const Eigen::Index p = loss.shapes();
  const auto joint = [&](const Eigen::VectorXd& x) { return loss.joint(x); };
  if (loss.separates()) {
    levenberg_marquardt_options by_products = descent;
    by_products.resolution = 1e-15 * loss.of_nothing();
    local_minimum found = levenberg_marquardt([&](const Eigen::VectorXd& u) { return loss.projected(u); }, shapes,
                                              {box.lowest.head(p), box.highest.head(p)}, by_products);
    Eigen::VectorXd x = loss.with_colours(found.unknowns);
    // Residuals that are small beside the measurements drown when they are had from products.
    if (found.value > 1e-8 * loss.of_nothing()) return {std::move(x), std::move(found)};
    local_minimum polished = levenberg_marquardt(joint, x, box, descent);
    polished.evaluations += found.evaluations;
    return {polished.unknowns, std::move(polished)};
  }
  const Eigen::VectorXd start = loss.with_colours(shapes);
  // The paper's stages: first colours, then shapes, then all.
  unknown_bounds stage = box;
  stage.lowest.head(p) = stage.highest.head(p) = start.head(p);
  const local_minimum coloured = levenberg_marquardt(joint, start, stage, descent);
  stage = box;
  stage.lowest.tail(start.size() - p) = stage.highest.tail(start.size() - p) = coloured.unknowns.tail(start.size() - p);
  const local_minimum shaped = levenberg_marquardt(joint, coloured.unknowns, stage, descent);
  local_minimum found = levenberg_marquardt(joint, shaped.unknowns, box, descent);
  found.evaluations += coloured.evaluations + shaped.evaluations;
  return {found.unknowns, std::move(found)};
}

template <class Metric>
[[nodiscard]] model_fit fit_model_by(const std::vector<const lobe_kind*>& kinds,
                                     std::span<const fit_observation> observations, Metric metric,
                                     const model_fit_options& options) {
  if (kinds.empty()) throw error("a model needs at least one lobe");
  std::size_t parameters = 0;
  for (const lobe_kind* kind : kinds) parameters += 3 + kind->parameters().size();
  if (3 * observations.size() < parameters)
    throw error(std::to_string(observations.size()) + " samples of three channels are too few for " +
                std::to_string(parameters) + " parameters");
  if (std::ranges::all_of(observations,
                          [](const fit_observation& seen) { return (seen.value == 0.0).all() || seen.weight == 0.0; }))
    throw error("all measurements are zero, or count for nothing");

  const model_loss<Metric> loss(kinds, observations, std::move(metric), options);
  auto [best, end] = fit_from(loss, loss.coded(typical_shapes(kinds)), options);
  std::size_t evaluations = end.evaluations;

  std::mt19937_64 random(options.seed);
  const unknown_bounds box = loss.bounds();
  for (std::size_t start = 0; start < options.random_starts; ++start) {
    Eigen::VectorXd shapes(loss.shapes());
    for (Eigen::Index j = 0; j < shapes.size(); ++j)
      shapes[j] = std::uniform_real_distribution(box.lowest[j], box.highest[j])(random);
    auto [x, other] = fit_from(loss, shapes, options);
    evaluations += other.evaluations;
    if (!(other.value < end.value)) continue;
    best = std::move(x);
    end = std::move(other);
  }
  return {loss.model(best), end.value, evaluations, end.converged, end.promised_gain};
}

}  // namespace detail

/// Fits a sum of lobes. Shapes are shared by the channels, colours are not, and none is negative; bounds are respected.
///
/// Without an initial guess: the consecutive optimisation of Nielsen et al. 2014 from typical shapes (colours; shapes;
/// all), which for squares of linear residuals becomes variable projection: the shapes alone, with the colours that are
/// best for them. `metric` maps reflectance before it is compared: lin, log or root. Throws
/// gonio::error for fewer measurements than parameters, or if all are zero. O(N (L + P)^2) an iteration for N
/// observations, L lobes and P parameters.
///
/// ```cpp
/// const std::vector kinds{&gonio::lobe_kind::of<gonio::lambert_shape>(), &gonio::lobe_kind_named("ggx")};
/// const auto fit = gonio::fit_model(kinds, gonio::fit_observations(samples));
/// ```
template <smooth_metric Metric = lin>
[[nodiscard]] model_fit fit_model(const std::vector<const lobe_kind*>& kinds,
                                  std::span<const fit_observation> observations, const Metric& metric = {},
                                  const model_fit_options& options = {}) {
  return detail::fit_model_by(kinds, observations, detail::chosen_metric(metric), options);
}

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/fit_model.ipp>
#endif
