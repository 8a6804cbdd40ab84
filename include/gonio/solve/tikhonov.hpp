#pragma once
/// Least squares with a quadratic penalty on the weights (ridge regression).
/// Nielsen et al. 2015, Eq. 11-12.

#include <gonio/solve/solver.hpp>

#include <Eigen/Cholesky>

#include <cmath>

namespace gonio {

/// Minimises |W^(1/2) (A x - b)|^2 + eta |x|^2, exactly.
///
/// A wide problem (fewer rows than unknowns) is solved through its n x n dual,
/// x = A~' (A~ A~' + eta I)^-1 b~ with A~ = W^(1/2) A, in O(n^2 k); a tall one through the k x k normal
/// equations (A~'A~ + eta I) x = A~'b~ in O(n k^2). Both give the same x.
class tikhonov {
 public:
  enum class form { automatic, primal, dual };

  /// Throws gonio::error unless eta is positive and finite. With columns scaled to unit variance (pca) eta
  /// is the variance of the noise, in the metric's units, summed over what the basis cannot say.
  explicit tikhonov(double eta, form solved_as = form::automatic) : eta_(eta), form_(solved_as) {
    if (!(eta > 0.0 && std::isfinite(eta)))
      throw error("the penalty eta of a Tikhonov solver must be positive and finite, not " + std::to_string(eta));
  }

  [[nodiscard]] double eta() const noexcept { return eta_; }

  template <class Problem = least_squares_problem>
  [[nodiscard]] solution solve(const Problem& problem) const {
    const bool wide = problem.equations() < problem.unknowns();
    const bool through_dual = form_ == form::dual || (form_ == form::automatic && wide);
    const Eigen::MatrixXd x = through_dual ? solve_dual(problem) : solve_primal(problem);
    return {x, problem.residual(x), certificate(problem, x), 0};
  }

 private:
  template <class Problem>
  [[nodiscard]] Eigen::MatrixXd solve_primal(const Problem& problem) const {
    Eigen::MatrixXd penalised = problem.normal().gram;
    penalised.diagonal().array() += eta_;
    return penalised.llt().solve(problem.normal().moment);
  }

  template <class Problem>
  [[nodiscard]] Eigen::MatrixXd solve_dual(const Problem& problem) const {
    row_matrix rows = problem.rows();
    Eigen::MatrixXd right = problem.right_hand_side();
    for (Eigen::Index row = 0; row < rows.rows(); ++row) {
      const double root = std::sqrt(problem.weights()[row]);
      rows.row(row) *= root;
      right.row(row) *= root;
    }
    Eigen::MatrixXd penalised = rows * rows.transpose();
    penalised.diagonal().array() += eta_;
    const Eigen::MatrixXd dual = penalised.llt().solve(right);
    return rows.transpose() * dual;
  }

  /// The gradient A'W(Ax - b) + eta x vanishes at the optimum.
  template <class Problem>
  [[nodiscard]] Eigen::VectorXd certificate(const Problem& problem, const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd misfit = problem.rows() * x;
    misfit -= problem.right_hand_side();
    Eigen::MatrixXd weighted = problem.right_hand_side();
    for (Eigen::Index row = 0; row < misfit.rows(); ++row) {
      misfit.row(row) *= problem.weights()[row];
      weighted.row(row) *= problem.weights()[row];
    }
    Eigen::MatrixXd gradient = problem.rows().transpose() * misfit;
    gradient += eta_ * x;
    const Eigen::MatrixXd moment = problem.rows().transpose() * weighted;
    return stationarity(gradient, moment);
  }

  double eta_;
  form form_;
};

static_assert(solver<tikhonov>);

}  // namespace gonio
