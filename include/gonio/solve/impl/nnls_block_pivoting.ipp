#pragma once
/// Bodies of solve/nnls_block_pivoting.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/active_set.hpp>
#include <gonio/solve/nnls_block_pivoting.hpp>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace gonio {

GONIO_INLINE block_pivoting::block_pivoting(const normal_equations& normal, Eigen::Index right_hand_side)
    : normal_(normal),
      right_hand_side_(right_hand_side),
      moment_(normal.moment().col(right_hand_side)),
      x_(Eigen::VectorXd::Zero(normal.unknowns())),
      free_(static_cast<std::size_t>(normal.unknowns()), false),
      fewest_wrong_(normal.unknowns() + 1) {
  find_wrong(Eigen::VectorXd(-moment_));
}

GONIO_INLINE void block_pivoting::find_wrong(const Eigen::VectorXd& gradient) {
  const Eigen::VectorXd norms = normal_.gram().diagonal().cwiseSqrt();
  double terms = 0.0;
  for (Eigen::Index j = 0; j < x_.size(); ++j)
    if (norms[j] > 0.0) terms = std::max(terms, std::abs(moment_[j]) / norms[j]);
  terms += x_.cwiseAbs().dot(norms);
  wrong_.clear();
  for (Eigen::Index j = 0; j < x_.size(); ++j) {
    const bool is_free = free_[static_cast<std::size_t>(j)];
    if (is_free ? x_[j] <= 0.0 : gradient[j] < -1e-13 * terms * norms[j]) wrong_.push_back(j);
  }
}

}  // namespace gonio
