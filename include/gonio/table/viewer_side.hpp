#pragma once
/// Determines on which side of the normal the viewer is. Instruments count angles and azimuths from the light or from
/// the mirror direction. A scan read with the wrong convention has its highlight in the direction of the light.

#include <gonio/table/sample_set.hpp>

namespace gonio {

/// Returns the ratio of brightness on the light's side of the normal, at the angle of incidence, to that on the other
/// side, in the mirror direction or, if that was not measured, anywhere. Uses samples in the plane of incidence, and
/// takes the median over incidences of 10 degrees and more; 0 if none has both sides. O(n log n).
[[nodiscard]] double brightness_towards_light(const sample_set& samples);

/// Materials that reflect more light back than this are rarer than scans read with the wrong convention.
inline constexpr double implausible_brightness_towards_light = 2.0;

/// Returns the same values, with each viewer rotated by half a turn about the normal.
[[nodiscard]] sample_set with_viewers_turned(const sample_set& samples);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/viewer_side.ipp>
#endif
