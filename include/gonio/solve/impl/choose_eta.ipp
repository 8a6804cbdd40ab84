#pragma once
/// Bodies of solve/choose_eta.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/choose_eta.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace gonio::detail {

GONIO_INLINE Eigen::VectorXd geometric(double first, double last, Eigen::Index count) {
  const double step = std::log(last / first) / static_cast<double>(count - 1);
  Eigen::VectorXd numbers(count);
  for (Eigen::Index i = 0; i < count; ++i) numbers[i] = first * std::exp(step * static_cast<double>(i));
  return numbers;
}

GONIO_INLINE Eigen::Index last_least(const Eigen::VectorXd& scores) {
  const double bound = scores.minCoeff() * (1.0 + 1e-10);
  Eigen::Index at = scores.size() - 1;
  while (at > 0 && !(scores[at] <= bound)) --at;
  return at;
}

GONIO_INLINE void require_etas(const eta_range& range) {
  if (!(range.lowest >= 0.0 && range.lowest <= range.highest && range.highest > 0.0 && std::isfinite(range.lowest)))
    throw error("a range of eta goes from a number that is not negative to a larger one, not from " +
                std::to_string(range.lowest) + " to " + std::to_string(range.highest));
}

}  // namespace gonio::detail
