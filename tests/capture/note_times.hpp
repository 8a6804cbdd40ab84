#pragma once

#include <array>

/// The exposure times in seconds of the note on relative BRDF measurement (Nielsen's thesis 2016).
inline constexpr std::array note_times{0.0125, 0.025, 0.05, 0.1, 0.2};
