#pragma once
/// Tikhonov's penalty where nobody says otherwise.

namespace gonio {

/// For a design, which has no measurements to choose by. Between what `eta_of_unknown_noise` chooses for real samples
/// of 20 directions (2 to 7) and of 5 and 10 (11 to 27): docs/directions.md. Nielsen et al. 2015 and Xu et al. 2016
/// have 40.
inline constexpr double default_eta = 10.0;

}  // namespace gonio
