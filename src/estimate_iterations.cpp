// The bodies of estimate/ that iterate over products of their own, apart from estimate.cpp so that both compile side by
// side.

#include <gonio/estimate/impl/correction_iteration.ipp>
#include <gonio/estimate/impl/pose_refinement.ipp>
#include <gonio/estimate/robust_reconstruction.hpp>

namespace gonio {

template class detail::reweighted_combination<log>;
template class robust_run<log>;
template class robust_reconstruction<log>;

}  // namespace gonio
