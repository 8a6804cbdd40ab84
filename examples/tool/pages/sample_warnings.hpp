#pragma once
/// Warnings about samples that are accepted, but are likely to give poor results.

#include <gonio/io/measurements/samples.hpp>
#include <gonio/table/sample_set.hpp>

#include <string>
#include <vector>

namespace cli {

/// Are all channels equal?
[[nodiscard]] inline bool is_grey(const gonio::rgb& value) { return value.x() == value.y() && value.y() == value.z(); }

/// Do samples with the same half and difference angles differ by more than a quarter (median) between azimuths?
[[nodiscard]] bool looks_anisotropic(const gonio::sample_set& samples);

/// Returns a sentence for each of these: noise above 50 %, repeats of the same angles that differ by more than the
/// noise (relative, 0.02 is 2 %), a largest value so frequent that the detector may be saturated, negative values of
/// more than half of the samples, one value for all samples, and directions that are all in the plane of incidence. The
/// first sample has the number 1. O(n log n) for n samples.
[[nodiscard]] std::vector<std::string> warnings_of(const gonio::sample_set& samples, double noise);

/// Returns a sentence for each sign that a file's numbers are misread: angles in radians (light and viewer of all
/// samples are within 3.2 degrees of the normal); reflectance factors or percent (away from highlights, at half angles
/// above 30 degrees, half of the samples reflect more than a white diffuser); a BRDF times the cosine of the viewer's
/// angle (the values there fall like this cosine); or, unless the side is stated, a highlight on the light's side of
/// the normal. docs/results/implausible-samples.md measures how often these sentences are right. O(n log n).
[[nodiscard]] std::vector<std::string> doubts_of(const gonio::io::sample_file& file);

/// Returns how many samples with nonzero weight repeat the directions of an earlier one, to a thousandth of a degree.
/// O(n log n).
[[nodiscard]] Eigen::Index repeated_samples(const gonio::sample_set& samples);

}  // namespace cli
