#pragma once
/// Bodies of solve/tikhonov.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/solver.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Cholesky>

#include <cmath>

namespace gonio {

GONIO_INLINE tikhonov::tikhonov(double eta, form solved_as) : eta_(eta), form_(solved_as) {
  if (!(eta > 0.0 && std::isfinite(eta)))
    throw error("the penalty eta of a Tikhonov solver must be positive and finite, not " + std::to_string(eta));
}

}  // namespace gonio
