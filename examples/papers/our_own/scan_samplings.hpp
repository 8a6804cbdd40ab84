#pragma once
/// Directions as scans have them: close together in one region or plane, and nowhere else.

#include "papers/our_own/left_out_families.hpp"

#include <vector>

namespace papers {

/// 20, 60 and 500 below some theta_h, where what lies 8 degrees beyond is judged; one incidence and four in one plane,
/// four in two planes, in steps of 1 to 10 degrees.
[[nodiscard]] std::vector<sampling> scan_samplings();

}  // namespace papers
