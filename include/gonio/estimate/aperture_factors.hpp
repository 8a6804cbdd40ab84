#pragma once
/// What apertures make of readings, by a fit of them.

#include <gonio/core/parallel.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace gonio::detail {

/// The mean over a sample's cones to the value in the middle, for each channel: a row for each of `numbers`. At most
/// 100, at least a hundredth, and 1 where nothing is reflected. `values` has at least as many channels as the samples.
[[nodiscard]] Eigen::MatrixXd aperture_factors(
    const sample_set& samples, const std::vector<Eigen::Index>& numbers,
    const std::function<Eigen::ArrayXd(const direction& wi, const direction& wo)>& values, thread_count threads);

}  // namespace gonio::detail

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/aperture_factors.ipp>
#endif
