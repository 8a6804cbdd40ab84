// The bodies of estimate/ that iterate over products of their own, apart from estimate.cpp so that both compile side by
// side.

#include <gonio/estimate/impl/pose_refinement.ipp>
