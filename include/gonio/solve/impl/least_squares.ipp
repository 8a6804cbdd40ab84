#pragma once
/// Bodies of solve/least_squares.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/least_squares.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <string>

namespace gonio::detail {

GONIO_INLINE Eigen::VectorXd divisors(Eigen::VectorXd norms) {
  for (double& norm : norms)
    if (!(norm > 0.0)) norm = 1.0;
  return norms;
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE least_squares::least_squares(double rank_threshold) : threshold_(rank_threshold) {
  if (!(rank_threshold >= 0.0 && rank_threshold < 1.0))
    throw error("the rank threshold of a least-squares solver must be at least 0 and less than 1, not " +
                std::to_string(rank_threshold));
}

}  // namespace gonio
