#pragma once
/// All of `robust/`: the correction functions of Noell et al. 2014, their iteration, and its outlier weights.

#include <gonio/robust/corrected_brdf.hpp>
#include <gonio/robust/correction.hpp>
#include <gonio/robust/correction_iteration.hpp>
#include <gonio/robust/nearest_material.hpp>
#include <gonio/robust/outlier_weights.hpp>
#include <gonio/robust/robust_reconstruction.hpp>
#include <gonio/robust/sampled_functions.hpp>
