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
      rhs_(normal.rhs().col(right_hand_side)),
      x_(Eigen::VectorXd::Zero(normal.unknowns())),
      free_(static_cast<std::size_t>(normal.unknowns()), false),
      fewest_wrong_(normal.unknowns() + 1) {
  find_wrong(Eigen::VectorXd(-rhs_));
}

GONIO_INLINE void block_pivoting::find_wrong(const Eigen::VectorXd& gradient) {
  const Eigen::VectorXd norms = normal_.gram().diagonal().cwiseSqrt();
  double terms = 0.0;
  for (Eigen::Index j = 0; j < x_.size(); ++j)
    if (norms[j] > 0.0) terms = std::max(terms, std::abs(rhs_[j]) / norms[j]);
  terms += x_.cwiseAbs().dot(norms);
  wrong_.clear();
  for (Eigen::Index j = 0; j < x_.size(); ++j) {
    const bool is_free = free_[static_cast<std::size_t>(j)];
    if (is_free ? x_[j] <= 0.0 : gradient[j] < -1e-13 * terms * norms[j]) wrong_.push_back(j);
  }
}

}  // namespace gonio

namespace gonio {

GONIO_INLINE void block_pivoting::step() {
  if (!wrong_.empty()) exchange();
  if (wrong_.empty() || ++steps_ >= 3 * x_.size() + 20) finish();
}

GONIO_INLINE void block_pivoting::exchange() {
  const auto wrong = std::ssize(wrong_);
  if (wrong < fewest_wrong_) {
    fewest_wrong_ = wrong;
    chances_ = 3;
  } else {
    --chances_;
  }
  const std::size_t first = chances_ > 0 ? 0 : wrong_.size() - 1;
  for (std::size_t i = first; i < wrong_.size(); ++i) {
    const auto j = static_cast<std::size_t>(wrong_[i]);
    free_[j] = !free_[j];
  }
  solve_free();
}

GONIO_INLINE void block_pivoting::finish() {
  x_ = finish_by_active_set<sign_rule::non_negative>(normal_, right_hand_side_, 0.0, x_, "block principal pivoting");
  finished_ = true;
}

GONIO_INLINE void block_pivoting::solve_free() {
  growing_cholesky factor(normal_.unknowns());
  std::vector<Eigen::Index> passive;
  Eigen::VectorXd cross(normal_.unknowns());
  for (Eigen::Index j = 0; j < x_.size(); ++j) {
    if (!free_[static_cast<std::size_t>(j)]) continue;
    const auto count = std::ssize(passive);
    for (Eigen::Index i = 0; i < count; ++i) cross[i] = normal_.gram()(passive[static_cast<std::size_t>(i)], j);
    // A column that depends on the free ones adds nothing: it stays at zero.
    if (factor.append(cross.head(count), normal_.gram()(j, j)))
      passive.push_back(j);
    else
      free_[static_cast<std::size_t>(j)] = false;
  }
  Eigen::VectorXd z(std::ssize(passive));
  for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = rhs_[passive[static_cast<std::size_t>(i)]];
  factor.solve(z);
  x_.setZero();
  Eigen::VectorXd gradient = -rhs_;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const Eigen::Index j = passive[static_cast<std::size_t>(i)];
    x_[j] = z[i];
    gradient += z[i] * normal_.gram().col(j);
  }
  find_wrong(gradient);
}

GONIO_INLINE solution nnls_block_pivoting::solve(const least_squares_problem& problem) const {
  const auto start = [&](Eigen::Index column) { return iteration(problem.normal(), column); };
  return solve_signed<sign_rule::non_negative>(problem, 0.0, "block principal pivoting", start);
}

GONIO_INLINE solution nnls_block_pivoting::solve(const normal_equations& normal) const {
  const auto start = [&](Eigen::Index column) { return iteration(normal, column); };
  return solve_signed<sign_rule::non_negative>(normal, 0.0, "block principal pivoting", start);
}

}  // namespace gonio
