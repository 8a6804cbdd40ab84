// The bodies of evaluate/.

#include <gonio/evaluate/impl/appearance_metric.ipp>
#include <gonio/evaluate/impl/comparison.ipp>
#include <gonio/evaluate/impl/perceived_candidates.ipp>
#include <gonio/evaluate/impl/perceived_norm.ipp>
#include <gonio/evaluate/impl/perceived_sensitivity.ipp>
#include <gonio/evaluate/impl/simulated_measurement.ipp>
#include <gonio/evaluate/impl/sphere_delta_e.ipp>
#include <gonio/evaluate/impl/test_materials.ipp>

namespace gonio {

template comparison compare(const brdf_table&, const brdf_table&, const log_relative&, const appearance_metric&,
                            thread_count);

}  // namespace gonio
