/// Must not compile: non-negative weights of functions with arbitrary signs.

#include <gonio/basis/pca.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/solve/nnls.hpp>

void refuse(const gonio::pca<gonio::log>& components) { gonio::decomposition estimator{components, gonio::nnls{}}; }
