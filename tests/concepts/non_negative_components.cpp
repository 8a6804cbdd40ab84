/// Must not compile: weights >= 0 of functions whose signs are arbitrary.

#include <gonio/basis/pca.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/solve/nnls.hpp>

void refuse(const gonio::pca<gonio::log>& components) { gonio::decomposition estimator{components, gonio::nnls{}}; }
