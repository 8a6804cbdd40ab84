#pragma once
/// All of `estimate/`, the heart: from samples to a BRDF on a basis.

#include <gonio/estimate/angular_error.hpp>
#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/decomposition_parts.hpp>
#include <gonio/estimate/errors_in_variables_decomposition.hpp>
#include <gonio/estimate/estimator.hpp>
#include <gonio/estimate/eta_of_noise.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/estimate/highlight_contrast.hpp>
#include <gonio/estimate/inliers.hpp>
#include <gonio/estimate/learn_streamed_soft_specular.hpp>
#include <gonio/estimate/leave_one_material_out_error.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/mapped_noise.hpp>
#include <gonio/estimate/out_of_gamut.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/pose_refinement.hpp>
#include <gonio/estimate/reconstructed.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/estimate/sample_process.hpp>
#include <gonio/estimate/sample_regions.hpp>
#include <gonio/estimate/scaled_likelihood.hpp>
#include <gonio/estimate/soft_or_specular.hpp>
#include <gonio/estimate/soft_specular_decomposition.hpp>
#include <gonio/estimate/values_at.hpp>
