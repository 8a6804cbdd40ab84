#pragma once
/// Coordinate descent on the normal equations for min 1/2 x'Q x - m'x + lambda |x|_1, with or without x >= 0, with
/// covariance updates and sweeps over the non-zero weights alone as in Friedman, Hastie and Tibshirani (J. Stat.
/// Software 33, 2010, doi:10.18637/jss.v033.i01).

#include <gonio/solve/active_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gonio {

/// A step sweeps over all weights once, and then a few times over the non-zero weights. Sweeps find quickly which
/// weights are zero; if the condition number is large, they find the values of the non-zero weights slowly. After a
/// step that leaves the signs unchanged, or after 20 steps, `active_set` finishes. A sweep costs O(k) for each weight
/// that changes.
template <sign_rule Signs>
class coordinate_descent {
 public:
  /// `lambda` >= 0. Keeps a reference to `normal`.
  coordinate_descent(const normal_equations& normal, Eigen::Index right_hand_side, double lambda = 0.0)
      : normal_(normal),
        right_hand_side_(right_hand_side),
        lambda_(lambda),
        x_(Eigen::VectorXd::Zero(normal.unknowns())),
        descent_(normal.rhs().col(right_hand_side)) {}

  /// Makes a step of sweeps. Once the signs do not change, finishes by the active set.
  void step() {
    const Eigen::VectorXd before = x_.cwiseSign();
    for (Eigen::Index j = 0; j < x_.size(); ++j) relax(j);
    for (int sweep = 0; sweep < sweeps_over_support; ++sweep)
      for (Eigen::Index j = 0; j < x_.size(); ++j)
        if (x_[j] != 0.0) relax(j);
    if (++steps_ >= patience || x_.cwiseSign() == before) finish();
  }

  [[nodiscard]] bool converged() const noexcept { return finished_; }
  [[nodiscard]] const Eigen::VectorXd& result() const noexcept { return x_; }

 private:
  static constexpr int sweeps_over_support = 4;
  static constexpr int patience = 20;  // steps; the active set then finds the exact support

  /// Moves one weight to its optimum while all others stay fixed: a soft threshold.
  void relax(Eigen::Index j) {
    const double square = normal_.gram()(j, j);
    if (square == 0.0) return;
    const double alone = descent_[j] + square * x_[j];
    double next = std::max(std::abs(alone) - lambda_, 0.0) / square;
    if (alone < 0.0) next = Signs == sign_rule::any ? -next : 0.0;
    const double change = next - x_[j];
    if (change == 0.0) return;
    x_[j] = next;
    descent_ -= change * normal_.gram().col(j);
  }

  void finish() {
    x_ = finish_by_active_set<Signs>(normal_, right_hand_side_, lambda_, x_, "coordinate descent");
    finished_ = true;
  }

  const normal_equations& normal_;
  Eigen::Index right_hand_side_;
  double lambda_;
  Eigen::VectorXd x_, descent_;
  int steps_ = 0;
  bool finished_ = false;
};
static_assert(solver_iteration<coordinate_descent<sign_rule::any>>);

}  // namespace gonio
