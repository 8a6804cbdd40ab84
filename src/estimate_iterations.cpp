// The bodies of estimate/ that iterate over products of their own. A separate file, compiled in parallel with
// estimate.cpp.

#include <gonio/estimate/impl/pose_refinement.ipp>
