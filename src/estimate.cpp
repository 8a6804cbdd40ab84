// The bodies of estimate/, but for what estimate_iterations.cpp has.

#include <gonio/estimate/impl/angular_error.ipp>
#include <gonio/estimate/impl/highlight_contrast.ipp>
#include <gonio/estimate/impl/leave_one_material_out_error.ipp>
#include <gonio/estimate/impl/located_samples.ipp>
#include <gonio/estimate/impl/mapped_noise.ipp>
#include <gonio/estimate/impl/nearest_material.ipp>
#include <gonio/estimate/impl/outlier_mixture.ipp>
#include <gonio/estimate/impl/outlier_weights.ipp>
#include <gonio/estimate/impl/outlying_samples.ipp>
#include <gonio/estimate/impl/pull_push.ipp>
#include <gonio/estimate/impl/sample_regions.ipp>
