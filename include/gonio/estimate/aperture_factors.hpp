#pragma once
/// The effect of apertures on readings, predicted by a fit.

#include <gonio/core/parallel.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace gonio::detail {

/// Returns the mean of `values` over a sample's cones divided by the value on their axes: one row for each of the
/// samples whose positions are in `numbers`, one column for each channel. Factors are clamped to 0.01 to 100. They are
/// 1 for a sample without an aperture, and where `values` are not positive. `values` must have at least as many
/// channels as the samples.
[[nodiscard]] Eigen::MatrixXd aperture_factors(
    const sample_set& samples, const std::vector<Eigen::Index>& numbers,
    const std::function<Eigen::ArrayXd(const direction& wi, const direction& wo)>& values, thread_count threads);

}  // namespace gonio::detail

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/aperture_factors.ipp>
#endif
