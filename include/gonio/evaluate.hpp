#pragma once
/// All of `evaluate/`: measures the quality of an estimate.

#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/next_measurement.hpp>
#include <gonio/evaluate/perceived_candidates.hpp>
#include <gonio/evaluate/perceived_norm.hpp>
#include <gonio/evaluate/perceived_sensitivity.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/evaluate/sphere_delta_e.hpp>
#include <gonio/evaluate/test_materials.hpp>
