// The bodies of robust/.

#include <gonio/robust/impl/correction_iteration.ipp>
#include <gonio/robust/impl/outlier_weights.ipp>
#include <gonio/robust/robust_reconstruction.hpp>

namespace gonio {

template class detail::reweighted_combination<log>;
template class robust_run<log>;
template class robust_reconstruction<log>;

}  // namespace gonio
