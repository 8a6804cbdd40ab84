#pragma once
/// Tikhonov's penalty where nobody says otherwise.

namespace gonio {

/// For a design, which has no measurements to choose by: about what `eta_of_unknown_noise` chooses for real ones
/// (docs/eta.md). Nielsen et al. 2015 and Xu et al. 2016 have 40.
inline constexpr double default_eta = 3.0;

}  // namespace gonio
