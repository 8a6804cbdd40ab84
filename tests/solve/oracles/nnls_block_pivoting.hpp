#pragma once
/// Non-negative least squares by block principal pivoting: Portugal, Judice and Vicente, Math. Comp. 63, 1994; Kim and
/// Park, SIAM J. Sci. Comput. 33, 2011, algorithm 2.

#include <gonio/solve/active_set.hpp>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace gonio {

/// Guesses the free weights, solves for them, and then exchanges all with a wrong sign at once: weights below zero, and
/// gradients that point inside. Takes few steps, each with its own factorisation, O(p^3 / 3 + k p). If the number of
/// wrong signs does not fall for three steps, it exchanges only the last wrong one (Murty's rule), which cannot cycle
/// if the free columns are independent. Once all signs are right, or after 3 k + 20 steps, `active_set` finishes from
/// there.
class block_pivoting {
 public:
  /// Keeps a reference to `normal`.
  block_pivoting(const normal_equations& normal, Eigen::Index right_hand_side);

  /// Exchanges wrong signs, or finishes.
  void step();

  [[nodiscard]] bool converged() const noexcept { return finished_; }
  [[nodiscard]] const Eigen::VectorXd& result() const noexcept { return x_; }

 private:
  void exchange();

  void finish();

  void solve_free();

  void find_wrong(const Eigen::VectorXd& gradient);

  const normal_equations& normal_;
  Eigen::Index right_hand_side_;
  Eigen::VectorXd rhs_;
  Eigen::VectorXd x_;
  std::vector<bool> free_;
  std::vector<Eigen::Index> wrong_;
  std::ptrdiff_t fewest_wrong_;
  int chances_ = 3;
  Eigen::Index steps_ = 0;
  bool finished_ = false;
};

/// Minimises |W^(1/2) (A x - b)|^2 over x >= 0, like `nnls`, in fewer and larger steps; docs/results/solvers.md
/// compares both. Throws gonio::error in the same cases as `nnls`.
class nnls_block_pivoting {
 public:
  static constexpr bool non_negative = true;
  using iteration = block_pivoting;

  [[nodiscard]] solution solve(const least_squares_problem& problem) const;
  [[nodiscard]] solution solve(const normal_equations& normal) const;
};

static_assert(normal_solver<nnls_block_pivoting>);

}  // namespace gonio

namespace gonio {

inline block_pivoting::block_pivoting(const normal_equations& normal, Eigen::Index right_hand_side)
    : normal_(normal),
      right_hand_side_(right_hand_side),
      rhs_(normal.rhs().col(right_hand_side)),
      x_(Eigen::VectorXd::Zero(normal.unknowns())),
      free_(normal.unknowns(), false),
      fewest_wrong_(normal.unknowns() + 1) {
  find_wrong(Eigen::VectorXd(-rhs_));
}

inline void block_pivoting::find_wrong(const Eigen::VectorXd& gradient) {
  const Eigen::VectorXd norms = normal_.gram().diagonal().cwiseSqrt();
  double terms = 0.0;
  for (Eigen::Index j = 0; j < x_.size(); ++j)
    if (norms[j] > 0.0) terms = std::max(terms, std::abs(rhs_[j]) / norms[j]);
  terms += x_.cwiseAbs().dot(norms);
  wrong_.clear();
  for (Eigen::Index j = 0; j < x_.size(); ++j) {
    const bool is_free = free_[j];
    if (is_free ? x_[j] <= 0.0 : gradient[j] < -1e-13 * terms * norms[j]) wrong_.push_back(j);
  }
}

}  // namespace gonio

namespace gonio {

inline void block_pivoting::step() {
  if (!wrong_.empty()) exchange();
  if (wrong_.empty() || ++steps_ >= 3 * x_.size() + 20) finish();
}

inline void block_pivoting::exchange() {
  const auto wrong = std::ssize(wrong_);
  if (wrong < fewest_wrong_) {
    fewest_wrong_ = wrong;
    chances_ = 3;
  } else {
    --chances_;
  }
  const std::size_t first = chances_ > 0 ? 0 : wrong_.size() - 1;
  for (std::size_t i = first; i < wrong_.size(); ++i) {
    const std::size_t j = wrong_[i];
    free_[j] = !free_[j];
  }
  solve_free();
}

inline void block_pivoting::finish() {
  x_ = finish_by_active_set<sign_rule::non_negative>(normal_, right_hand_side_, 0.0, x_, "block principal pivoting");
  finished_ = true;
}

inline void block_pivoting::solve_free() {
  growing_cholesky factor(normal_.unknowns());
  std::vector<Eigen::Index> passive;
  Eigen::VectorXd cross(normal_.unknowns());
  for (Eigen::Index j = 0; j < x_.size(); ++j) {
    if (!free_[j]) continue;
    const auto count = std::ssize(passive);
    for (Eigen::Index i = 0; i < count; ++i) cross[i] = normal_.gram()(passive[i], j);
    // A column that depends on the free ones adds nothing, so its weight stays zero.
    if (factor.append(cross.head(count), normal_.gram()(j, j)))
      passive.push_back(j);
    else
      free_[j] = false;
  }
  Eigen::VectorXd z(std::ssize(passive));
  for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = rhs_[passive[i]];
  factor.solve(z);
  x_.setZero();
  Eigen::VectorXd gradient = -rhs_;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const Eigen::Index j = passive[i];
    x_[j] = z[i];
    gradient += z[i] * normal_.gram().col(j);
  }
  find_wrong(gradient);
}

inline solution nnls_block_pivoting::solve(const least_squares_problem& problem) const {
  const auto start = [&](Eigen::Index column) { return iteration(problem.normal(), column); };
  return solve_signed<sign_rule::non_negative>(problem, 0.0, "block principal pivoting", start);
}

inline solution nnls_block_pivoting::solve(const normal_equations& normal) const {
  const auto start = [&](Eigen::Index column) { return iteration(normal, column); };
  return solve_signed<sign_rule::non_negative>(normal, 0.0, "block principal pivoting", start);
}

}  // namespace gonio
