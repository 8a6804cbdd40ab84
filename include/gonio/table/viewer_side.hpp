#pragma once
/// On which side of the normal the viewer is: instruments count angles and azimuths from the light or from the mirror
/// direction, and a scan that is read the wrong way round has its highlight where the light comes from.

#include <gonio/table/sample_set.hpp>

namespace gonio {

/// How much brighter samples in the plane of incidence are on the light's side of the normal, at the angle of
/// incidence, than on the other side in the mirror direction or, where that was not measured, anywhere: the median over
/// incidences of 10 degrees and more; 0 if none has both sides. O(n log n).
[[nodiscard]] double brightness_towards_light(const sample_set& samples);

/// Materials that reflect more light back than this are rarer than scans the wrong way round.
inline constexpr double implausible_brightness_towards_light = 2.0;

/// The same values, with the viewer half a turn about the normal from where it was.
[[nodiscard]] sample_set with_viewers_turned(const sample_set& samples);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/table/impl/viewer_side.ipp>
#endif
