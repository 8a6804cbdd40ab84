// The bodies of estimate/ except those in estimate_iterations.cpp.

#include <gonio/basis/measured.hpp>
#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/estimate/impl/angular_error.ipp>
#include <gonio/estimate/impl/aperture_factors.ipp>
#include <gonio/estimate/impl/highlight_contrast.ipp>
#include <gonio/estimate/impl/inliers.ipp>
#include <gonio/estimate/impl/learn_streamed_soft_specular.ipp>
#include <gonio/estimate/impl/leave_one_material_out_error.ipp>
#include <gonio/estimate/impl/located_samples.ipp>
#include <gonio/estimate/impl/mapped_noise.ipp>
#include <gonio/estimate/impl/mirror_envelope.ipp>
#include <gonio/estimate/impl/out_of_gamut.ipp>
#include <gonio/estimate/impl/outlier_mixture.ipp>
#include <gonio/estimate/impl/reconstructed.ipp>
#include <gonio/estimate/impl/sample_process.ipp>
#include <gonio/estimate/impl/sample_regions.ipp>
#include <gonio/estimate/impl/scaled_likelihood.ipp>
#include <gonio/estimate/impl/soft_specular_decomposition.ipp>
#include <gonio/estimate/impl/solve_rows.ipp>
#include <gonio/estimate/impl/spectral_spikes.ipp>
#include <gonio/estimate/impl/wrong_samples.ipp>
#include <gonio/metric/log.hpp>

namespace gonio {

template class basis_equations<log_relative_pca>;
template class basis_equations<measured<log>>;
template class fitted_brdf<log_relative_pca>;
template class fitted_brdf<measured<log>>;

}  // namespace gonio
