#pragma once
/// The concept of an estimator: samples in, a BRDF over all directions out.

#include <gonio/core/brdf.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

namespace gonio {

/// A BRDF that can also be tabulated onto any grid faster than by evaluating it cell by cell.
template <class Fit>
concept tabulated_brdf = brdf<Fit> && requires(const Fit& fit, const valid_cells& cells) {
  { fit.tabulate(cells) } -> std::same_as<brdf_table>;
};

/// Completes a BRDF from scattered measurements.
///
/// What the compiler cannot check, and a model must keep: `fit` refuses unusable samples with gonio::error
/// (`require_usable`), does not depend on the number of threads, and the result is non-negative and zero
/// below the horizon; `fit(...).tabulate(cells)` agrees with evaluating the fit at the cells' angles up to
/// float rounding; fitting is const and thread safe.
template <class Estimator>
concept estimator = requires(const Estimator& candidate, const sample_set& samples) {
  { candidate.fit(samples) } -> tabulated_brdf;
};

}  // namespace gonio
