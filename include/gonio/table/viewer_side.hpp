#pragma once
/// Determines on which side of the normal the viewer is. Instruments count angles and azimuths from the light or from
/// the mirror direction. A scan read with the wrong convention has its highlight in the direction of the light.

#include <gonio/table/sample_set.hpp>

namespace gonio {

/// Returns the brightness towards the light divided by the brightness in the mirror direction or, if the mirror
/// direction was not measured, by the largest brightness on its side of the normal. Uses samples in the plane of
/// incidence, and takes the median over angles of incidence of at least 10 degrees; 0 if no angle has both values. O(n
/// log n).
[[nodiscard]] double brightness_towards_light(const sample_set& samples);

/// Above this ratio, a scan read with the wrong convention is more likely than a material that reflects so much light
/// back.
inline constexpr double implausible_brightness_towards_light = 2.0;

/// Returns the same values, with each viewer rotated by half a turn about the normal.
[[nodiscard]] sample_set with_viewers_turned(const sample_set& samples);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/viewer_side.ipp>
#endif
