#pragma once
/// Certificates of optimality: how far weights are from the Karush-Kuhn-Tucker conditions of their problem, computed
/// from the problem and the weights alone, so that nobody has to trust a solver.

#include <gonio/solve/normal_equations.hpp>

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace gonio {

/// The gradient Q x - m of one right-hand side, in units in which every column of A has length 1: entry j is divided by
/// sqrt(Q_jj) (by 1 for a column of zeros), which makes certificates independent of the columns' scales.
struct scaled_gradient {
  Eigen::VectorXd value;
  /// The largest sum of magnitudes, |m_j| + sum over i of |Q_ji x_i|, that went into an entry, never 0: rounding alone
  /// leaves about 1e-16 of it in the gradient at the exact optimum. Certificates are relative to it.
  double scale = 1.0;
  Eigen::VectorXd column_norms;
};

/// O(k times the number of non-zero weights).
template <class Vector>
[[nodiscard]] scaled_gradient gradient_of(const normal_equations& normal, Eigen::Index right_hand_side,
                                          const Eigen::MatrixBase<Vector>& x) {
  scaled_gradient result;
  result.value = -normal.moment().col(right_hand_side);
  Eigen::VectorXd magnitude = result.value.cwiseAbs();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (x[i] == 0.0) continue;
    result.value += x[i] * normal.gram().col(i);
    magnitude += std::abs(x[i]) * normal.gram().col(i).cwiseAbs();
  }
  result.column_norms = normal.gram().diagonal().cwiseSqrt();
  double largest = 0.0;
  for (Eigen::Index j = 0; j < result.value.size(); ++j) {
    double& norm = result.column_norms[j];
    if (norm == 0.0) norm = 1.0;
    result.value[j] /= norm;
    largest = std::max(largest, magnitude[j] / norm);
  }
  if (largest > 0.0) result.scale = largest;
  return result;
}

/// Without constraints: the gradient vanishes.
template <class Matrix>
[[nodiscard]] Eigen::VectorXd stationarity(const normal_equations& normal, const Eigen::MatrixBase<Matrix>& x) {
  Eigen::VectorXd violation(x.cols());
  for (Eigen::Index column = 0; column < x.cols(); ++column) {
    const scaled_gradient gradient = gradient_of(normal, column, x.col(column));
    violation[column] = gradient.value.cwiseAbs().maxCoeff() / gradient.scale;
  }
  return violation;
}

/// Which weights a penalised or constrained problem allows.
enum class sign_rule { any, non_negative };

/// The KKT conditions of min 1/2 x'Q x - m'x + lambda |x|_1, with or without x >= 0; lambda = 0 with
/// `sign_rule::non_negative` is NNLS. Where x_j > 0 the gradient is -lambda, where x_j < 0 it is lambda, and where x_j
/// = 0 it is at least -lambda and, unless x >= 0, at most lambda; an x_j < 0 that is not allowed counts in full.
template <class Matrix>
[[nodiscard]] Eigen::VectorXd kkt_violation(const normal_equations& normal, const Eigen::MatrixBase<Matrix>& x,
                                            double lambda, sign_rule signs) {
  Eigen::VectorXd violation(x.cols());
  for (Eigen::Index column = 0; column < x.cols(); ++column) {
    const scaled_gradient gradient = gradient_of(normal, column, x.col(column));
    double worst = 0.0;
    for (Eigen::Index j = 0; j < x.rows(); ++j) {
      const double weight = x(j, column), slope = gradient.value[j], penalty = lambda / gradient.column_norms[j];
      double off = 0.0;
      if (weight > 0.0)
        off = std::abs(slope + penalty);
      else if (weight < 0.0)
        off = signs == sign_rule::any ? std::abs(slope - penalty) : std::numeric_limits<double>::infinity();
      else
        off = signs == sign_rule::any ? std::abs(slope) - penalty : -slope - penalty;
      worst = std::max(worst, off);
    }
    violation[column] = worst / gradient.scale;
  }
  return violation;
}

}  // namespace gonio
