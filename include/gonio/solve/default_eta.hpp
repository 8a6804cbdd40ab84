#pragma once
/// Tikhonov's default penalty.

namespace gonio {

/// The default penalty for designing measurements, before there are any to choose a penalty from: the penalty of
/// Nielsen et al. 2015 (doi:10.1145/2816795.2818085) and Xu et al. 2016 (doi:10.1145/2980179.2982396). Directions
/// designed with eta 40 reconstruct real tables outside the prior about as well as directions designed with 10, 3 or 1,
/// although the tables' samples lead to penalties of 14, 7 and 3 for 5, 10 and 20 points (docs/results/directions.md).
inline constexpr double default_eta = 40.0;

}  // namespace gonio
