// The bodies of design/.

#include <gonio/design/impl/apparatus.ipp>
#include <gonio/design/impl/capture_constraint.ipp>
#include <gonio/design/impl/capture_geometry.ipp>
#include <gonio/design/impl/cell_candidates.ipp>
#include <gonio/design/impl/compressed_rows.ipp>
#include <gonio/design/impl/design_criterion.ipp>
#include <gonio/design/impl/error_sweep.ipp>
#include <gonio/design/impl/expected_error.ipp>
#include <gonio/design/impl/image_candidates.ipp>
#include <gonio/design/impl/near_field_geometry.ipp>
#include <gonio/design/impl/published_directions.ipp>
#include <gonio/design/impl/search.ipp>
#include <gonio/design/impl/sequential_design.ipp>
#include <gonio/design/impl/sphere_geometry.ipp>

namespace gonio::design {

template class extended_error<float>;
template class extended_error<double>;

}  // namespace gonio::design
