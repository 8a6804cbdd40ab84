#pragma once
/// Converts colours outside of Rec. 709 to positive numbers, because a logarithmic metric cannot distinguish negative
/// numbers.

#include <gonio/estimate/located_samples.hpp>

#include <optional>

namespace gonio {

/// Returns the samples as CIE XYZ relative to white if more than one in ten has a negative channel. The colours of a
/// saturated material lie outside of Rec. 709: one channel is negative in all samples. CIE XYZ of a reflectance is
/// never negative. Returns nothing if fewer samples have a negative channel, if there are not three channels, or if
/// channels have different weights. O(samples).
[[nodiscard]] std::optional<located_samples> out_of_gamut_as_xyz(const located_samples& samples);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/out_of_gamut.ipp>
#endif
