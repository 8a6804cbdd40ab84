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
  explicit tikhonov(double eta, form solved_as = form::automatic);

  [[nodiscard]] double eta() const noexcept { return eta_; }

  template <quadratic_problem Problem = least_squares_problem>
  [[nodiscard]] solution solve(const Problem& problem) const {
    if constexpr (requires { problem.rows(); }) {
      const bool wide = problem.equations() < problem.unknowns();
      if (form_ == form::dual || (form_ == form::automatic && wide)) return solve_dual(problem);
    }
    return solve_primal(problem);
  }

 private:
  template <class Problem>
  [[nodiscard]] solution solve_primal(const Problem& problem) const {
    const normal_equations& normal = problem.normal();
    Eigen::MatrixXd penalised = normal.gram();
    penalised.diagonal().array() += eta_;
    const normal_equations ridge(std::move(penalised), normal.moment());
    const Eigen::MatrixXd x = ridge.gram().llt().solve(ridge.moment());
    return {x, problem.residual(x), ridge.objective(x), stationarity(ridge, x)};
  }

  template <class Problem>
  [[nodiscard]] solution solve_dual(const Problem& problem) const {
    const row_matrix rows = problem.weighted_rows();
    const Eigen::MatrixXd right = problem.weighted_right_hand_side();
    Eigen::MatrixXd penalised = rows * rows.transpose();
    penalised.diagonal().array() += eta_;
    const Eigen::LLT<Eigen::MatrixXd> factors(penalised);
    Eigen::MatrixXd x = rows.transpose() * factors.solve(right);

    // The gradient A'W(A x - b) + eta x vanishes at the optimum; without the k x k Gram matrix.
    solution found;
    Eigen::MatrixXd misfit, gradient;
    const auto differentiate = [&] {
      misfit = rows * x - right;
      gradient = rows.transpose() * misfit + eta_ * x;
    };
    differentiate();
    // A step of Newton, with the inverse of A~'A~ + eta I through the dual (Woodbury): if eta is small and rows depend
    // on each other, A~' times a large dual solution has lost digits.
    x -= (gradient - rows.transpose() * factors.solve(rows * gradient)) / eta_;
    differentiate();
    const Eigen::MatrixXd moment = rows.transpose() * right;
    found.residual = misfit.colwise().norm();
    found.objective.resize(x.cols());
    found.certificate.resize(x.cols());
    for (Eigen::Index column = 0; column < x.cols(); ++column) {
      found.objective[column] = 0.5 * (misfit.col(column).squaredNorm() - right.col(column).squaredNorm() +
                                       eta_ * x.col(column).squaredNorm());
      const double scale = moment.col(column).cwiseAbs().maxCoeff();
      found.certificate[column] = gradient.col(column).cwiseAbs().maxCoeff() / (scale > 0.0 ? scale : 1.0);
    }
    found.weights = x;
    return found;
  }

  double eta_;
  form form_;
};

static_assert(normal_solver<tikhonov>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/tikhonov.ipp>
#endif
