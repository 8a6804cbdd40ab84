#pragma once
/// What is told of samples that are accepted, but are likely to disappoint.

#include <gonio/table/sample_set.hpp>

#include <string>
#include <vector>

namespace cli {

/// A sentence for each: noise above 50 %, repeats of the same angles that contradict each other by more than the noise
/// (relative, 0.02 is 2 %), one value everywhere, and directions that are all in the plane of incidence. Samples are
/// numbered from 1. O(n log n).
[[nodiscard]] std::vector<std::string> warnings_of(const gonio::sample_set& samples, double noise);

/// How many samples that count have the directions of one before, to a thousandth of a degree. O(n log n).
[[nodiscard]] Eigen::Index repeated_samples(const gonio::sample_set& samples);

}  // namespace cli
