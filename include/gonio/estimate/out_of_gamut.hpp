#pragma once
/// Colours that Rec. 709 does not hold, where a logarithm is to judge them.

#include <gonio/estimate/located_samples.hpp>

#include <optional>

namespace gonio {

/// Samples as outliers are judged. The colours of a saturated material lie outside of Rec. 709: a channel is negative
/// in all samples, and a logarithm cannot tell one of them from another. Where more than one sample in ten has a
/// negative channel, colours become CIE XYZ relative to white, which no reflectance makes negative. Nothing if fewer
/// have, or if their channels count apart. O(samples).
[[nodiscard]] std::optional<located_samples> out_of_gamut_as_xyz(const located_samples& samples);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/out_of_gamut.ipp>
#endif
