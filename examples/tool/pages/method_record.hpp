#pragma once
/// How the methods of `gonio reconstruct` compare on measured materials, as warnings: docs/results/real-methods.md.

#include <Eigen/Core>

#include <string>

namespace cli {

/// From so many samples correction comes nearer than pca where many samples are wrong: `gonio reconstruct` corrects
/// fewer only if it is asked for something that no other method has.
constexpr Eigen::Index fewest_corrected_samples = 2000;

/// A sentence for people if a method has been more than twice as far off as pca, or further off than the median
/// material, on any of the measured materials, from the nearest number of samples that was tried and is not above this
/// one; empty if it has not.
[[nodiscard]] std::string warning_of(const std::string& method, Eigen::Index samples);

}  // namespace cli
