#pragma once
/// Converts colours outside of Rec. 709, so that a logarithm can judge them.

#include <gonio/estimate/located_samples.hpp>

#include <optional>

namespace gonio {

/// Returns the samples in a space in which outliers can be judged. The colours of a saturated material lie outside of
/// Rec. 709: one channel is negative in all samples, and a logarithm cannot distinguish negative values. If more than
/// one sample in ten has a negative channel, colours become CIE XYZ relative to white, which no reflectance makes
/// negative. Returns nothing if fewer have, or if channels have weights of their own. O(samples).
[[nodiscard]] std::optional<located_samples> out_of_gamut_as_xyz(const located_samples& samples);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/out_of_gamut.ipp>
#endif
