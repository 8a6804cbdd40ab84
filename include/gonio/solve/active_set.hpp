#pragma once
/// A primal active-set method for min 1/2 x'Q x - m'x + lambda |x|_1 (Q and m as in normal_equations.hpp), with or
/// without x >= 0. NNLS, Lasso and non-negative Lasso are the same algorithm with different allowed signs.
///
/// With x >= 0 and lambda = 0, the method is NNLS by Lawson and Hanson (Solving Least Squares Problems, 1974,
/// doi:10.1137/1.9781611971217) on the normal equations (Bro and de Jong, J. Chemometrics 11, 1997,
/// doi:10.1002/(SICI)1099-128X(199709/10)11:5<393::AID-CEM483>3.0.CO;2-L); with both signs, it is the feature-sign
/// search of Lee, Battle, Raina and Ng (NIPS 2006).

#include <gonio/solve/compensated.hpp>
#include <gonio/solve/growing_cholesky.hpp>
#include <gonio/solve/iteration.hpp>
#include <gonio/solve/kkt.hpp>
#include <gonio/solve/signed_solution.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// Each weight is passive (free, with a fixed sign) or zero. A step lets the most promising column enter the passive
/// columns and moves to their optimum; columns whose weights would change sign leave. While the passive columns are
/// independent, every step lowers the objective, so no passive set recurs. A column that depends on other passive
/// columns up to rounding leaves again, which may raise the objective; it is barred until another column has entered.
/// `step_limit` ends cycles. A step costs O(k p + p^2) for k columns, p of them passive, and O(p^2) more for each
/// column that leaves.
template <sign_rule Signs>
class active_set {
 public:
  /// `lambda` >= 0. Keeps a reference to `normal`.
  active_set(const normal_equations& normal, Eigen::Index right_hand_side, double lambda = 0.0)
      : gram_(normal.gram()),
        rhs_(normal.rhs().col(right_hand_side)),
        lambda_(lambda),
        factor_(normal.unknowns()),
        sign_(Eigen::VectorXd::Zero(normal.unknowns())),
        x_(Eigen::VectorXd::Zero(normal.unknowns())),
        descent_(rhs_),
        norms_(gram_.diagonal().cwiseSqrt()),
        barred_(normal.unknowns(), false) {
    for (Eigen::Index j = 0; j < norms_.size(); ++j)
      if (norms_[j] > 0.0) rhs_scale_ = std::max(rhs_scale_, std::abs(rhs_[j]) / norms_[j]);
    choose_entering();
  }

  /// Starts from weights near the optimum, such as those of a similar problem. Their signs become the passive set.
  void start_from(const Eigen::VectorXd& near_optimum) {
    for (Eigen::Index j = 0; j < near_optimum.size(); ++j) {
      const bool allowed = Signs == sign_rule::any ? near_optimum[j] != 0.0 : near_optimum[j] > 0.0;
      if (!allowed || !append(j)) continue;
      sign_[j] = near_optimum[j] > 0.0 ? 1.0 : -1.0;
      x_[j] = near_optimum[j];
    }
    settle();
    update_descent();
    look_for_entering();
    if (entering_ >= 0) return;
    // If columns depend on each other up to rounding, too many may have left: one of the barred columns may be needed
    // again.
    barred_.assign(barred_.size(), false);
    choose_entering();
  }

  /// Lets one column enter and moves to the optimum of the passive columns.
  void step() {
    const Eigen::Index entering = entering_;
    sign_[entering] = descent_[entering] > 0.0 ? 1.0 : -1.0;
    if (enter(entering)) {
      barred_.assign(barred_.size(), false);
      update_descent();
    } else {
      sign_[entering] = 0.0;
      barred_[entering] = true;
    }
    look_for_entering();
  }

  [[nodiscard]] bool converged() const noexcept { return entering_ < 0; }
  [[nodiscard]] const Eigen::VectorXd& result() const noexcept { return x_; }

 private:
  /// Adds a column to the passive ones. Returns false if it cannot enter because of rounding.
  [[nodiscard]] bool enter(Eigen::Index column) {
    if (!append(column)) return exchange(column);
    const Eigen::VectorXd z = optimum_of_passive();
    if (z[z.size() - 1] * sign_[column] > 0.0) {
      settle();
      return true;
    }
    drop(std::ssize(passive_) - 1);
    return false;
  }

  [[nodiscard]] bool append(Eigen::Index column) {
    Eigen::VectorXd cross(std::ssize(passive_));
    for (Eigen::Index i = 0; i < cross.size(); ++i) cross[i] = gram_(passive_[i], column);
    if (!factor_.append(cross, gram_(column, column))) return false;
    passive_.push_back(column);
    return true;
  }

  /// Lets a column enter that depends on the passive columns. Only |x|_1 can then become smaller: moves along the
  /// direction that leaves A x unchanged until a passive weight is zero, and replaces the column of this weight.
  [[nodiscard]] bool exchange(Eigen::Index column) {
    if (lambda_ == 0.0) return false;
    Eigen::VectorXd combination(std::ssize(passive_));
    for (Eigen::Index i = 0; i < combination.size(); ++i) combination[i] = gram_(passive_[i], column);
    factor_.solve(combination);
    double length = std::numeric_limits<double>::infinity();
    Eigen::Index first = -1;
    for (Eigen::Index i = 0; i < combination.size(); ++i) {
      const Eigen::Index j = passive_[i];
      const double shrinking = combination[i] * sign_[column] * sign_[j];
      if (shrinking > 0.0 && std::abs(x_[j]) / shrinking < length) {
        length = std::abs(x_[j]) / shrinking;
        first = i;
      }
    }
    if (first < 0) return false;
    for (Eigen::Index i = 0; i < combination.size(); ++i) x_[passive_[i]] -= length * sign_[column] * combination[i];
    drop(first);
    if (!append(column)) return false;
    x_[column] = length * sign_[column];
    settle();
    return true;
  }

  void drop(Eigen::Index position) {
    const auto dropped = passive_.begin() + position;
    x_[*dropped] = sign_[*dropped] = 0.0;
    factor_.remove(position);
    passive_.erase(dropped);
  }

  /// Solves Q_PP z = m_P - lambda s_P.
  [[nodiscard]] Eigen::VectorXd optimum_of_passive() const {
    Eigen::VectorXd z(std::ssize(passive_));
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      const Eigen::Index j = passive_[i];
      z[i] = rhs_[j] - lambda_ * sign_[j];
    }
    factor_.solve(z);
    return z;
  }

  /// Moves to the optimum of the passive columns. If a weight would change its sign on the way, stops there, lets its
  /// column leave and starts again. If the optimum is `refined`, bars leaving columns, because they entered due to
  /// rounding.
  void settle(bool refined = false) {
    for (int round = 0; !passive_.empty(); ++round) {
      if (round > step_limit(x_.size())) refuse("an active set does not converge: the normal equations overflow");
      Eigen::VectorXd z = optimum_of_passive();
      if (refined) refine(z);
      double length = 1.0;
      bool inside = true;
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        const Eigen::Index j = passive_[i];
        if (z[i] * sign_[j] > 0.0) continue;
        inside = false;
        const double distance = std::abs(x_[j]) + std::abs(z[i]);
        length = std::min(length, distance > 0.0 ? std::abs(x_[j]) / distance : 0.0);
      }
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        const Eigen::Index j = passive_[i];
        x_[j] = inside ? z[i] : x_[j] + length * (z[i] - x_[j]);
      }
      if (inside) return;
      for (Eigen::Index i = z.size() - 1; i >= 0; --i) {
        const Eigen::Index j = passive_[i];
        const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(z[i]);
        if (z[i] * sign_[j] > 0.0 || x_[j] * sign_[j] > rounding) continue;
        barred_[j] = refined;
        drop(i);
      }
    }
  }

  /// Refines the weights z of the passive columns iteratively, with residuals in twice the precision. The optimum of an
  /// ill-conditioned passive set is then independent of the order in which its columns entered. Signs may change.
  void refine(Eigen::VectorXd& z) const {
    Eigen::VectorXd correction(z.size());
    for (int round = 0; round < 3; ++round) {
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        const Eigen::Index row = passive_[i];
        compensated_sum misfit(rhs_[row]);
        misfit.add(-lambda_ * sign_[row]);
        for (Eigen::Index j = 0; j < z.size(); ++j) misfit.add_product(-gram_(passive_[j], row), z[j]);
        correction[i] = misfit.value();
      }
      factor_.solve(correction);
      bool changed = false;
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        changed = changed || std::abs(correction[i]) > 1e-14 * std::abs(z[i]);
        z[i] += correction[i];
      }
      if (!changed) return;
    }
  }

  /// Computes m - Q x.
  void update_descent() {
    descent_ = rhs_;
    for (const Eigen::Index j : passive_) descent_ -= x_[j] * gram_.col(j);
  }

  /// Chooses the column that enters next. Refines the weights before deciding that no column can enter.
  void look_for_entering() {
    choose_entering();
    if (entering_ >= 0) return;
    do {
      settle(true);
      update_descent();
    } while (drop_unresolved());
    choose_entering();
  }

  /// Drops and bars the passive column with the smallest relative pivot, if the passive weights are not at their
  /// optimum. This happens if a column became passive although it depends on others up to rounding. Returns true if a
  /// column was dropped.
  [[nodiscard]] bool drop_unresolved() {
    double worst = 0.0, least = std::numeric_limits<double>::infinity();
    std::ptrdiff_t weakest = -1;
    for (std::ptrdiff_t i = 0; i < std::ssize(passive_); ++i) {
      const Eigen::Index j = passive_[i];
      worst = std::max(worst, std::abs(descent_[j] - lambda_ * sign_[j]) / norms_[j]);
      const double share = factor_.pivot(i) / gram_(j, j);
      if (share >= least) continue;
      least = share;
      weakest = i;
    }
    if (weakest < 0 || worst <= 1e-11 * terms()) return false;
    barred_[passive_[weakest]] = true;
    drop(weakest);
    return true;
  }

  /// Returns the size of the terms of the gradient that cancel each other, for columns of length 1.
  [[nodiscard]] double terms() const {
    double sum = rhs_scale_;
    for (const Eigen::Index j : passive_) sum += std::abs(x_[j]) * norms_[j];
    return sum;
  }

  /// Chooses, among the columns of weight zero, the column that lowers the objective fastest per unit length of A x.
  /// Chooses none if no column lowers it by more than rounding.
  void choose_entering() {
    double best = 1e-15 * terms();
    entering_ = -1;
    for (Eigen::Index j = 0; j < descent_.size(); ++j) {
      if (sign_[j] != 0.0 || norms_[j] == 0.0 || barred_[j]) continue;
      const double slope = Signs == sign_rule::any ? std::abs(descent_[j]) : descent_[j];
      if (slope - lambda_ <= best * norms_[j]) continue;
      best = (slope - lambda_) / norms_[j];
      entering_ = j;
    }
  }

  const Eigen::MatrixXd& gram_;
  Eigen::VectorXd rhs_;
  double lambda_;
  growing_cholesky factor_;
  std::vector<Eigen::Index> passive_;  // in the order in which the factor contains them
  Eigen::VectorXd sign_;               // 0: not passive
  Eigen::VectorXd x_, descent_, norms_;
  std::vector<bool> barred_;
  double rhs_scale_ = 0.0;
  Eigen::Index entering_ = -1;
};
static_assert(solver_iteration<active_set<sign_rule::any>>);

/// Returns the optimum, starting from weights near it. This is the last stage of a method that finds the support (the
/// non-zero weights) first. Throws gonio::error naming the `method` if it does not converge.
template <sign_rule Signs>
[[nodiscard]] Eigen::VectorXd finish_by_active_set(const normal_equations& normal, Eigen::Index right_hand_side,
                                                   double lambda, const Eigen::VectorXd& near_optimum,
                                                   const std::string& method) {
  active_set<Signs> exact(normal, right_hand_side, lambda);
  exact.start_from(near_optimum);
  run_to_convergence(exact, step_limit(normal.unknowns()), method);
  return exact.result();
}

/// Minimises 1/2 x'Q x - m'x + lambda |x|_1 under a sign rule and certifies the result (`detail::certified`).
/// `start(column)` returns the iteration for a right-hand side. `problem` is a least_squares_problem or
/// normal_equations. Throws gonio::error naming the `method` if no optimum can be certified.
template <sign_rule Signs, quadratic_problem Problem, class Start>
[[nodiscard]] solution solve_signed(const Problem& problem, double lambda, const std::string& method, Start&& start) {
  const normal_equations& normal = problem.normal();
  Eigen::MatrixXd weights(normal.unknowns(), normal.right_hand_sides());
  int iterations = 0;
  for (Eigen::Index column = 0; column < weights.cols(); ++column) {
    try {
      auto run = start(column);
      iterations += run_to_convergence(run, step_limit(normal.unknowns()), method);
      weights.col(column) = run.result();
    } catch (const error&) {  // the iteration cycles: certification finds the optimum in another way
      weights.col(column).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  solution found = detail::certified(problem, {Signs, lambda, method}, std::move(weights));
  found.report.iterations = iterations;
  return found;
}

}  // namespace gonio
