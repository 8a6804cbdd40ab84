#pragma once
/// All of `estimate/`: from samples to a BRDF.

#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/completed_table.hpp>
#include <gonio/estimate/corrected_brdf.hpp>
#include <gonio/estimate/correction_iteration.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/estimator.hpp>
#include <gonio/estimate/eta_of_noise.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/estimate/leave_one_out.hpp>
#include <gonio/estimate/left_out_error.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/mapped_noise.hpp>
#include <gonio/estimate/misplaced_decomposition.hpp>
#include <gonio/estimate/nearest_material.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/outlier_weights.hpp>
#include <gonio/estimate/planned_decomposition.hpp>
#include <gonio/estimate/pose_refinement.hpp>
#include <gonio/estimate/pull_push.hpp>
#include <gonio/estimate/robust_reconstruction.hpp>
#include <gonio/estimate/sample_regions.hpp>
#include <gonio/estimate/sampled_functions.hpp>
#include <gonio/estimate/soft_or_specular.hpp>
#include <gonio/estimate/values_at.hpp>
