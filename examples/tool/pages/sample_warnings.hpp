#pragma once
/// What is told of samples that are accepted, but are likely to disappoint.

#include <gonio/io/measurements/samples.hpp>
#include <gonio/table/sample_set.hpp>

#include <string>
#include <vector>

namespace cli {

/// Is it one value in all channels?
[[nodiscard]] inline bool is_grey(const gonio::rgb& value) { return value.x() == value.y() && value.y() == value.z(); }

/// A sentence for each: noise above 50 %, repeats of the same angles that contradict each other by more than the noise
/// (relative, 0.02 is 2 %), a largest value that is read so often that the detector may be saturated, more negative
/// values than others, one value everywhere, and directions that are all in the plane of incidence. Samples are
/// numbered from 1. O(n log n).
[[nodiscard]] std::vector<std::string> warnings_of(const gonio::sample_set& samples, double noise);

/// A sentence for each way in which the numbers of a file look like something else than they are read as: angles in
/// radians (light and viewer of all samples are within 3.2 degrees of the normal), reflectance factors or percent (away
/// from highlights, at half angles above 30 degrees, half of the samples reflect more than a white diffuser), a BRDF
/// times the cosine of the viewer's angle (there the values fall like that cosine), the highlight on the light's side
/// of the normal, unless it is stated. How often that is right: docs/results/implausible-samples.md. O(n log n).
[[nodiscard]] std::vector<std::string> doubts_of(const gonio::io::sample_file& file);

/// How many samples that count have the directions of one before, to a thousandth of a degree. O(n log n).
[[nodiscard]] Eigen::Index repeated_samples(const gonio::sample_set& samples);

}  // namespace cli
