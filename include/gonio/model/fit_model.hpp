#pragma once
/// Fits sums of lobes to measurements.
/// J. B. Nielsen, J. R. Frisvad, K. Conradsen and H. Aanaes, "Addressing Grazing Angle Reflections in Phong Models",
/// SIGGRAPH Asia 2014 posters (consecutive optimisation, L1 norm); G. H. Golub and V. Pereyra, "The Differentiation of
/// Pseudo-Inverses and Nonlinear Least Squares Problems Whose Variables Separate", 1973 (doi:10.1137/0710036), and L.
/// Kaufman, "A Variable Projection Method for Solving Separable Nonlinear Least Squares Problems", 1975
/// (doi:10.1007/BF01932995; colours are solved for exactly).

#include <gonio/model/model_loss.hpp>

#include <Eigen/Core>

#include <span>
#include <vector>

namespace gonio::model {

/// A fitted model, and figures that describe how it was found.
struct model_fit {
  analytic_brdf model;
  double loss = 0.0;  ///< the weighted mean of the norm of the residual over measurements and channels
  Eigen::Index evaluations = 0;
  bool converged = false;
  double promised_gain = 0.0;  ///< see `local_minimum`
};

namespace detail {

/// Returns the parameters from which a fit starts. Lobes of the same kind need different starts; with equal starts they
/// stay equal. The first lobe of a kind has typical values. In the second, each logarithmic parameter has four times
/// its typical value, in the third a quarter, in the fourth 16 times, and so on. Other parameters move by a fifth of
/// their range at each step.
[[nodiscard]] std::vector<lobe_kind::values> typical_shapes(const std::vector<const lobe_kind*>& kinds);

[[nodiscard]] model_fit fit_model_by(const std::vector<const lobe_kind*>& kinds,
                                     std::span<const fit_observation> observations, chosen_metric metric,
                                     const model_fit_options& options);

}  // namespace detail

/// Fits a sum of lobes. All channels share the shapes, and each lobe has its own colour. No colour is negative, and all
/// parameters stay within their bounds.
///
/// Needs no initial guess: a shape whose axes can be rotated starts at four rotations. The fit follows the consecutive
/// optimisation of Nielsen et al. 2014 from typical shapes: first colours, then shapes, then both (the paper's last
/// stage keeps the diffuse colour: `diffuse_stays`). For squares of linear residuals, the fit uses variable projection
/// instead: it varies only the shapes and solves for their best colours. `metric` maps reflectance before the
/// comparison: lin, log or root. Throws gonio::error if there are fewer measurements than parameters, or if all are
/// zero. O(N (L + P)^2) per iteration for N observations, L lobes and P shape parameters.
///
/// ```cpp
/// const std::vector kinds{&gonio::model::lobe_kind::of<gonio::model::lambert_shape>(),
///                         &gonio::model::lobe_kind_named("ggx")};
/// const auto fit = gonio::model::fit_model(kinds, gonio::model::fit_observations(samples));
/// ```
template <smooth_metric Metric = lin>
[[nodiscard]] model_fit fit_model(const std::vector<const lobe_kind*>& kinds,
                                  std::span<const fit_observation> observations, const Metric& metric = {},
                                  const model_fit_options& options = {}) {
  return detail::fit_model_by(kinds, observations, detail::chosen_metric(metric), options);
}

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/fit_model.ipp>
#endif
