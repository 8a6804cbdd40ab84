#pragma once
/// Comparison of the methods of `gonio reconstruct` on measured materials, as warnings: docs/results/real-methods.md.

#include <Eigen/Core>

#include <string>

namespace cli {

/// From this number of samples, correction is nearer than pca if many samples are wrong. For fewer, `gonio reconstruct`
/// uses it only if one of its own options is given.
constexpr Eigen::Index fewest_corrected_samples = 2000;

/// Returns a sentence for people if, on any of the measured materials, the method was more than twice as far off as
/// pca, or further off than the median material, at the largest tried number of samples that is not above `samples`;
/// empty otherwise.
[[nodiscard]] std::string warning_of(const std::string& method, Eigen::Index samples);

}  // namespace cli
