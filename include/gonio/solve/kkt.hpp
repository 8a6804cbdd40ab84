#pragma once
/// KKT residuals: how far weights are from the Karush-Kuhn-Tucker conditions of their problem, computed
/// from the problem and the weights alone, so that nobody has to trust a solver.

#include <gonio/solve/normal_equations.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace gonio {

/// The gradient Q x - m of one right-hand side, in units in which every column of A has length 1: entry j is divided by
/// sqrt(Q_jj) (by 1 for a column of zeros), which makes KKT residuals independent of the columns' scales.
struct scaled_gradient {
  Eigen::VectorXd value;
  /// The largest sum of magnitudes, |m_j| + sum over i of |Q_ji x_i|, that went into an entry, never 0: rounding alone
  /// leaves about 1e-16 of it in the gradient at the exact optimum. KKT residuals are relative to it.
  double scale = 1.0;
  Eigen::VectorXd column_norms;
};

/// O(k times the number of non-zero weights).
[[nodiscard]] scaled_gradient gradient_of(const normal_equations& normal, Eigen::Index right_hand_side,
                                          const Eigen::Ref<const Eigen::VectorXd>& x);

/// Without constraints: the gradient vanishes.
[[nodiscard]] Eigen::VectorXd stationarity(const normal_equations& normal, const Eigen::MatrixXd& x);

/// Which weights a penalised or constrained problem allows.
enum class sign_rule { any, non_negative };

namespace detail {

/// The conditions below of one right-hand side, given the gradient at x, which has an entry for each unknown.
[[nodiscard]] double kkt_violation(const scaled_gradient& gradient, const double* x, double lambda, sign_rule signs);

}  // namespace detail

/// The KKT conditions of min 1/2 x'Q x - m'x + lambda |x|_1, with or without x >= 0; lambda = 0 with
/// `sign_rule::non_negative` is NNLS. Where x_j > 0 the gradient is -lambda, where x_j < 0 it is lambda, and where x_j
/// = 0 it is at least -lambda and, unless x >= 0, at most lambda. An x_j < 0 that is not allowed is an infinite
/// violation, as is one that is not finite.
[[nodiscard]] Eigen::VectorXd kkt_violation(const normal_equations& normal, const Eigen::MatrixXd& x, double lambda,
                                            sign_rule signs);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/kkt.ipp>
#endif
