// The bodies of estimate/pose_refinement.hpp. A separate file, compiled in parallel with estimate.cpp.

#include <gonio/estimate/impl/pose_refinement.ipp>
