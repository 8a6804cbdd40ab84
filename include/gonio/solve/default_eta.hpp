#pragma once
/// Tikhonov's default penalty.

namespace gonio {

/// For a design, where no measurements exist to choose a penalty by: that of Nielsen et al. 2015
/// (doi:10.1145/2816795.2818085) and Xu et al. 2016 (doi:10.1145/2980179.2982396). Real tables that no prior has seen
/// are reconstructed as well from directions designed for 40 as from those for 10, 3 or 1, and better from five points
/// (docs/results/directions.md), although `eta_of_unknown_noise` then chooses 4 to 27 for their samples.
inline constexpr double default_eta = 40.0;

}  // namespace gonio
