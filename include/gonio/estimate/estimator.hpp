#pragma once
/// The concept of an estimator, which reconstructs a BRDF over all directions from samples.

#include <gonio/core/brdf.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

namespace gonio {

/// A BRDF that tabulates itself on any grid, usually faster than cell by cell.
template <class Fit>
concept tabulated_brdf = brdf<Fit> && requires(const Fit& fit, const valid_cells& cells) {
  { fit.tabulate(cells) } -> std::same_as<brdf_table>;
};

/// Completes a BRDF from scattered measurements.
///
/// Requirements that the compiler cannot check: `fit` refuses unusable samples with gonio::error (`require_usable`) and
/// does not depend on the number of threads. The result is non-negative and zero below the horizon.
/// `fit(...).tabulate(cells)` agrees with the fit at the cells' angles up to float rounding. Fitting is const and
/// thread safe.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/estimate/decomposition.hpp>
/// #include <gonio/io/materials/prior.hpp>
/// #include <gonio/io/measurements/samples.hpp>
/// #include <gonio/solve/tikhonov.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::decomposition estimator{gonio::io::read_prior("materials.prior"), gonio::tikhonov{40.0}};
///   const auto paint = estimator.fit(gonio::io::read_samples("paint.csv"));
///   std::printf("%g per steradian\n", paint({0, 0, 1}, {0, 0, 1}).x());
/// }
/// ```
/// With a model of your own, a Lambertian material with the mean of the samples:
/// ```cpp
/// #include <gonio/estimate/estimator.hpp>
///
/// struct grey_fit {
///   gonio::rgb value;
///   gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
///     return wi.z() > 0 && wo.z() > 0 ? value : gonio::rgb::Zero();
///   }
///   gonio::brdf_table tabulate(const gonio::valid_cells& cells) const { return gonio::tabulate(*this, cells); }
/// };
/// struct mean_estimator {
///   grey_fit fit(const gonio::sample_set& samples) const {
///     gonio::require_usable(samples);
///     gonio::rgb sum = gonio::rgb::Zero();
///     for (const gonio::sample& each : samples) sum += each.value;
///     return {(sum / static_cast<double>(samples.size())).max(0.0)};
///   }
/// };
/// static_assert(gonio::estimator<mean_estimator>);
///
/// int main() {
///   const gonio::sample one{gonio::half_difference{0.1, 0.2, 0.3}, gonio::rgb::Constant(0.25), 1.0};
///   return mean_estimator{}.fit({one}).tabulate(gonio::valid_cells()).at(0).x() == 0.25 ? 0 : 1;
/// }
/// ```
template <class Estimator>
concept estimator = requires(const Estimator& candidate, const sample_set& samples) {
  { candidate.fit(samples) } -> tabulated_brdf;
};

}  // namespace gonio
