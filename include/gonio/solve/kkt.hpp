#pragma once
/// KKT residuals: how far weights are from the Karush-Kuhn-Tucker conditions of their problem. They are computed from
/// the problem and the weights alone, independently of the solver.

#include <gonio/solve/normal_equations.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace gonio {

/// The gradient Q x - m of one right-hand side, for columns of A scaled to length 1: entry j is divided by sqrt(Q_jj),
/// or by 1 if column j is zero. KKT residuals are then independent of the columns' scales.
struct scaled_gradient {
  Eigen::VectorXd value;
  /// The number to which KKT residuals are relative: the largest sum of magnitudes |m_j| + sum over i of |Q_ji x_i| of
  /// any entry; never 0. At the exact optimum, rounding leaves about 1e-16 of it in the gradient.
  double scale = 1.0;
  Eigen::VectorXd column_norms;
};

/// Computes the gradient at x. O(k times the number of non-zero weights) for k weights.
[[nodiscard]] scaled_gradient gradient_of(const normal_equations& normal, Eigen::Index right_hand_side,
                                          const Eigen::Ref<const Eigen::VectorXd>& x);

/// Returns the KKT residuals of a problem without constraints, whose gradient vanishes at the optimum.
[[nodiscard]] Eigen::VectorXd stationarity(const normal_equations& normal, const Eigen::MatrixXd& x);

/// The signs of weights that a penalised or constrained problem allows.
enum class sign_rule { any, non_negative };

namespace detail {

/// Returns the violation of the KKT conditions of min 1/2 x'Q x - m'x + lambda |x|_1 under a sign rule, for one
/// right-hand side, given the gradient at x. x has an entry for each unknown.
[[nodiscard]] double kkt_violation(const scaled_gradient& gradient, const double* x, double lambda, sign_rule signs);

}  // namespace detail

/// Returns the violation of the KKT conditions of min 1/2 x'Q x - m'x + lambda |x|_1, with or without x >= 0. For NNLS,
/// use lambda = 0 and `sign_rule::non_negative`. At the optimum, the gradient is -lambda where x_j > 0 and lambda where
/// x_j < 0. Where x_j = 0, it is at least -lambda and, unless x >= 0 is required, at most lambda. A forbidden x_j < 0,
/// or a weight that is not finite, is an infinite violation.
[[nodiscard]] Eigen::VectorXd kkt_violation(const normal_equations& normal, const Eigen::MatrixXd& x, double lambda,
                                            sign_rule signs);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/kkt.ipp>
#endif
