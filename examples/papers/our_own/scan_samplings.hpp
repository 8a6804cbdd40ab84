#pragma once
/// Directions typical of scans: close together in one region or plane, and nowhere else.

#include "papers/our_own/left_out_families.hpp"

#include <vector>

namespace papers {

/// Returns 20, 60 and 500 directions below some theta_h, judged only from 8 degrees further out; then scans in steps of
/// 1 to 10 degrees: one and four incidences in one plane, four in two planes.
[[nodiscard]] std::vector<sampling> scan_samplings();

}  // namespace papers
