#pragma once
/// Warnings from the comparison of the methods of `gonio reconstruct` on measured materials
/// (docs/results/real-methods.md).

#include <Eigen/Core>

#include <string>

namespace cli {

/// With fewer samples than this, `gonio reconstruct` uses pca instead of correction, unless an option of correction is
/// given. With more, it uses correction as asked, and warns.
constexpr Eigen::Index fewest_corrected_samples = 2000;

/// Returns a warning if the method's error on any measured material was more than twice that of pca, or larger than
/// that of the median material; otherwise an empty text. Of the numbers of samples that were tried, uses the largest
/// that is at most `samples`.
[[nodiscard]] std::string warning_of(const std::string& method, Eigen::Index samples);

}  // namespace cli
