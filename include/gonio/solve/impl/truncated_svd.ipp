#pragma once
/// Bodies of solve/truncated_svd.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/solver.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace gonio {

GONIO_INLINE truncated_svd::truncated_svd(double explained_variance) : share_(explained_variance) {
  if (!(explained_variance > 0.0 && explained_variance <= 1.0))
    throw error("the explained variance of a truncated SVD must be above 0 and at most 1, not " +
                std::to_string(explained_variance));
}

GONIO_INLINE double truncated_svd::relative(const Eigen::MatrixXd& violation, double scale) {
  if (violation.size() == 0) return 0.0;
  return violation.cwiseAbs().maxCoeff() / (scale > 0.0 ? scale : 1.0);
}

}  // namespace gonio
