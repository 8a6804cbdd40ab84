#pragma once
/// The inlier weight of a measurement, given its estimate: the concept, and weights that depend on one residual alone.
/// Noell, Koehler and Stricker 2014, Eq. 13. estimate/outlier_mixture.hpp has `automatic_weights`, which need no
/// parameter.

#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/outlier_mixture.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace gonio {

/// Compares all measurements with their estimates and returns the weight of each, from 0 (an outlier) to 1.
///
/// Requirements that the compiler cannot check: `weigh` returns one number from 0 to 1 for each channel of each sample;
/// estimates are at least zero, measurements may be negative, both are finite; the order of the samples has no effect
/// except for rounding; all members are const and thread safe. If the weights are the same in two successive rounds,
/// the iteration does not build its normal equations again.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/basis/expand_materials.hpp>
/// #include <gonio/estimate/decomposition.hpp>
/// #include <gonio/io/materials/prior.hpp>
/// #include <gonio/io/measurements/samples.hpp>
/// #include <gonio/metric/log.hpp>
/// #include <gonio/robust/correction_iteration.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::measured materials{gonio::expand(gonio::io::read_prior("materials.prior")), gonio::log{}};
///   const gonio::correction_iteration estimator{gonio::decomposition{materials, gonio::nnls{}},
///                                               gonio::correction{materials}, gonio::relative_deviation_weights{3.0}};
///   const auto paint = estimator.fit(gonio::io::read_samples("measurements.csv"));
///   std::printf("%g of the samples counted less than half\n", paint.history().back().down_weighted);
/// }
/// ```
/// With a model of your own, which ignores measurements that are off by more than half:
/// ```cpp
/// #include <gonio/robust/outlier_weights.hpp>
///
/// #include <cstdio>
///
/// struct within_a_half {
///   gonio::channel_values weigh(const gonio::channel_values& measured, const gonio::channel_values& estimated) const {
///     return ((measured - estimated).abs() <= 0.5f * estimated).cast<float>();
///   }
/// };
/// static_assert(gonio::outlier_weighting<within_a_half>);
///
/// int main() {
///   const gonio::channel_values measured = gonio::channel_values::Ones(3, 2);
///   std::printf("%g\n", double{within_a_half{}.weigh(measured, 3.0f * measured)(0, 0)});
/// }
/// ```
template <class Weighting>
concept outlier_weighting = requires(const Weighting& weighting, const channel_values& measured) {
  { weighting.weigh(measured, measured) } -> std::convertible_to<channel_values>;
};

/// Gives every measurement full weight: gamma = 0.
struct equal_weights {
  [[nodiscard]] channel_values weigh(const channel_values& measured, const channel_values& /*estimated*/) const {
    return channel_values::Ones(3, measured.cols());
  }
};

static_assert(outlier_weighting<equal_weights>);

/// The weight exp(-gamma |rho - estimate| / estimate) of a measurement rho, Eq. 13, with the estimate at least a
/// millionth. A measurement from zero to its estimate has a weight of at least e^-gamma, so a start that is too bright
/// can decrease. If the estimate has no highlight yet, the samples of the highlight get the weights of outliers.
struct relative_deviation_weights {
  double gamma = 3.0;

  [[nodiscard]] channel_values weigh(const channel_values& measured, const channel_values& estimated) const;
};

static_assert(outlier_weighting<relative_deviation_weights>);

static_assert(outlier_weighting<automatic_weights>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/robust/impl/outlier_weights.ipp>
#endif
