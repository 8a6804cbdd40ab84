#pragma once
/// Bodies of model/fit_model.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/model/fit_model.hpp>
#include <gonio/model/model_loss.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::model::detail {

GONIO_INLINE std::vector<lobe_kind::values> typical_shapes(const std::vector<const lobe_kind*>& kinds) {
  std::vector<lobe_kind::values> shapes;
  for (Eigen::Index l = 0; l < std::ssize(kinds); ++l) {
    const auto before = std::count(kinds.begin(), kinds.begin() + l, kinds[l]);
    lobe_kind::values start = kinds[l]->typical();
    const auto about = kinds[l]->parameters();
    for (Eigen::Index p = 0; p < std::ssize(about) && before > 0; ++p) {
      const double way = (before % 2 == 1 ? 1.0 : -1.0) * static_cast<double>((before + 1) / 2);
      const double moved = about[p].logarithmic ? start[p] * std::exp2(2.0 * way)
                                                : start[p] + 0.2 * way * (about[p].highest - about[p].lowest);
      start[p] = std::clamp(moved, about[p].lowest, about[p].highest);
    }
    shapes.push_back(start);
  }
  return shapes;
}

/// Returns typical shapes. If they have periodic parameters, returns four versions, with these parameters in the
/// middles of four parts of their period.
[[nodiscard]] GONIO_INLINE std::vector<std::vector<lobe_kind::values>> usual_starts(
    const std::vector<const lobe_kind*>& kinds) {
  std::vector<std::vector<lobe_kind::values>> starts(4, typical_shapes(kinds));
  bool are_alike = true;
  for (std::size_t s = 0; s < starts.size(); ++s)
    for (std::size_t l = 0; l < kinds.size(); ++l)
      for (std::size_t p = 0; p < kinds[l]->parameters().size(); ++p) {
        const shape_parameter& about = kinds[l]->parameters()[p];
        if (!about.periodic) continue;
        are_alike = false;
        starts[s][l][p] = about.lowest + (static_cast<double>(s) + 0.5) / 4.0 * (about.highest - about.lowest);
      }
  if (are_alike) starts.resize(1);
  return starts;
}

/// Returns the options of the minimisation for the fit's norm.
[[nodiscard]] GONIO_INLINE levenberg_marquardt_options descent_of(const model_fit_options& options) {
  levenberg_marquardt_options descent{.iteration_limit = options.iteration_limit};
  // With reweighted squares, convergence to the minimum of another norm than L2 is only linear.
  if (options.norm != fit_norm::l2) descent.smallest_gain = 1e-10;
  return descent;
}

/// Bounds the albedo of a model. If the albedo exceeds the limit, continues the minimisation with a growing penalty.
/// Then darkens the colours to remove the remaining excess, about 1e-4.
GONIO_INLINE void bound_albedo(const model_loss& loss, Eigen::VectorXd& x, local_minimum& end,
                               const model_fit_options& options) {
  constexpr int bins = 400;
  if ((loss.relative_albedo(x, bins) <= 1.0).all()) return;
  for (const double steepness : {1.0, 1e2, 1e4}) {
    const Eigen::Index before = end.evaluations;
    end = levenberg_marquardt([&](const Eigen::VectorXd& u) { return loss.joint(u, steepness); }, x, loss.bounds(),
                              descent_of(options));
    end.evaluations += before;
    x = end.unknowns;
  }
  const rgb relative = loss.relative_albedo(x, bins).max(1.0);
  auto colours = x.tail(3 * loss.lobes()).reshaped(loss.lobes(), 3);
  for (Eigen::Index c = 0; c < 3; ++c) colours.col(c) /= relative[c];
  end.value = loss.joint(x).value;
}

/// Minimises over shapes and colours together, starting from given shapes and their best colours.
[[nodiscard]] GONIO_INLINE std::pair<Eigen::VectorXd, local_minimum> fit_from(const model_loss& loss,
                                                                              const Eigen::VectorXd& shapes,
                                                                              const model_fit_options& options) {
  const unknown_bounds box = loss.bounds();
  const levenberg_marquardt_options descent = descent_of(options);
  const Eigen::Index p = loss.shapes();
  const auto joint = [&](const Eigen::VectorXd& x) { return loss.joint(x); };
  if (loss.separates() && !options.diffuse_stays) {
    levenberg_marquardt_options by_products = descent;
    by_products.resolution = 1e-15 * loss.of_nothing();
    local_minimum found = levenberg_marquardt([&](const Eigen::VectorXd& u) { return loss.projected(u); }, shapes,
                                              {box.lowest.head(p), box.highest.head(p)}, by_products);
    Eigen::VectorXd x = loss.with_colours(found.unknowns);
    // Minimise again if the loss is tiny: residuals computed from products lose precision if they are small compared to
    // the measurements.
    if (found.value > 1e-8 * loss.of_nothing()) return {std::move(x), std::move(found)};
    local_minimum polished = levenberg_marquardt(joint, x, box, descent);
    polished.evaluations += found.evaluations;
    return {polished.unknowns, std::move(polished)};
  }
  const Eigen::VectorXd start = loss.with_colours(shapes);
  // The paper's stages: first colours, then shapes, then both (with `diffuse_stays`, except for the diffuse colours).
  unknown_bounds stage = box;
  stage.lowest.head(p) = stage.highest.head(p) = start.head(p);
  const local_minimum coloured = levenberg_marquardt(joint, start, stage, descent);
  stage = box;
  stage.lowest.tail(start.size() - p) = stage.highest.tail(start.size() - p) = coloured.unknowns.tail(start.size() - p);
  const local_minimum shaped = levenberg_marquardt(joint, coloured.unknowns, stage, descent);
  stage = box;
  for (Eigen::Index i = p; i < start.size() && options.diffuse_stays; ++i)
    if (loss.is_diffuse((i - p) % loss.lobes())) stage.lowest[i] = stage.highest[i] = shaped.unknowns[i];
  local_minimum found = levenberg_marquardt(joint, shaped.unknowns, stage, descent);
  found.evaluations += coloured.evaluations + shaped.evaluations;
  return {found.unknowns, std::move(found)};
}

GONIO_INLINE model_fit fit_model_by(const std::vector<const lobe_kind*>& kinds,
                                    std::span<const fit_observation> observations, chosen_metric metric,
                                    const model_fit_options& options) {
  if (kinds.empty()) refuse("a model needs at least one lobe");
  Eigen::Index parameters = 0;
  for (const lobe_kind* kind : kinds) parameters += 3 + kind->parameters().size();
  if (3 * std::ssize(observations) < parameters)
    refuse(std::to_string(observations.size()) + " samples of three channels are too few for " +
           std::to_string(parameters) + " parameters");
  if (!(options.largest_albedo > 0.0)) refuse({"the largest albedo must be positive, not ", options.largest_albedo});
  if (std::ranges::all_of(
          observations, [](const fit_observation& seen) { return (seen.value * seen.weight.of_each() == 0.0).all(); }))
    refuse("all measurements are zero or have weight zero");

  const model_loss loss(kinds, observations, std::move(metric), options);
  const std::vector<std::vector<lobe_kind::values>> usual = usual_starts(kinds);
  auto [best, end] = fit_from(loss, loss.coded(usual.front()), options);
  Eigen::Index evaluations = end.evaluations;
  const auto try_from = [&](const Eigen::VectorXd& shapes) {
    auto [x, other] = fit_from(loss, shapes, options);
    evaluations += other.evaluations;
    if (!(other.value < end.value)) return;
    best = std::move(x);
    end = std::move(other);
  };
  for (std::size_t start = 1; start < usual.size(); ++start) try_from(loss.coded(usual[start]));

  std::mt19937_64 random(options.seed);
  const unknown_bounds box = loss.bounds();
  for (Eigen::Index start = 0; start < options.random_starts; ++start) {
    Eigen::VectorXd shapes(loss.shapes());
    for (Eigen::Index j = 0; j < shapes.size(); ++j)
      shapes[j] = std::uniform_real_distribution(box.lowest[j], box.highest[j])(random);
    try_from(shapes);
  }
  end.evaluations = evaluations;
  if (std::isfinite(options.largest_albedo)) bound_albedo(loss, best, end, options);
  return {loss.model(best), end.value, end.evaluations, end.converged, end.promised_gain};
}

}  // namespace gonio::model::detail
