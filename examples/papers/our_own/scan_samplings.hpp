#pragma once
/// Directions typical of scans: close together in one region or plane.

#include "papers/our_own/left_out_families.hpp"

#include <vector>

namespace papers {

/// Returns 20, 60 and 500 directions below some theta_h, with coverage counted only from 8 degrees farther out; then
/// scans in steps of 1 to 10 degrees: one and four incidences in one plane, four in two planes; then images of
/// spheres and of flat samples from close by, in the shipped designs.
[[nodiscard]] std::vector<sampling> scan_samplings();

}  // namespace papers
