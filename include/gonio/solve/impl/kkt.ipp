#pragma once
/// Bodies of solve/kkt.hpp.

#include <gonio/core/assertion.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/solve/kkt.hpp>
#include <gonio/solve/normal_equations.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio {

namespace detail {

/// Computes the gradient for one right-hand side. `x` has an entry for each unknown.
[[nodiscard]] GONIO_INLINE scaled_gradient gradient_of(const normal_equations& normal, Eigen::Index right_hand_side,
                                                       const double* x) {
  const Eigen::Index k = normal.unknowns();
  scaled_gradient result{Eigen::VectorXd(k), 1.0, Eigen::VectorXd(k)};
  Eigen::VectorXd magnitude(k);
  for (Eigen::Index j = 0; j < k; ++j) {
    result.value[j] = -normal.rhs()(j, right_hand_side);
    magnitude[j] = std::abs(result.value[j]);
    result.column_norms[j] = std::sqrt(normal.gram()(j, j));
  }
  for (Eigen::Index i = 0; i < k; ++i) {
    if (x[i] == 0.0) continue;
    const double* column = &normal.gram()(0, i);
    for (Eigen::Index j = 0; j < k; ++j) {
      const double term = x[i] * column[j];
      result.value[j] += term;
      magnitude[j] += std::abs(term);
    }
  }
  double largest = 0.0;
  for (Eigen::Index j = 0; j < k; ++j) {
    double& norm = result.column_norms[j];
    if (norm == 0.0) norm = 1.0;
    result.value[j] /= norm;
    largest = std::max(largest, magnitude[j] / norm);
  }
  if (largest > 0.0) result.scale = largest;
  return result;
}

GONIO_INLINE double kkt_violation(const scaled_gradient& gradient, const double* x, double lambda, sign_rule signs) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (Eigen::Index j = 0; j < gradient.value.size(); ++j) {
    const double weight = x[j], slope = gradient.value[j], penalty = lambda / gradient.column_norms[j];
    if (!std::isfinite(weight) || !std::isfinite(slope)) return infinite;
    double off = 0.0;
    if (weight > 0.0)
      off = std::abs(slope + penalty);
    else if (weight < 0.0)
      off = signs == sign_rule::any ? std::abs(slope - penalty) : infinite;
    else
      off = signs == sign_rule::any ? std::abs(slope) - penalty : -slope - penalty;
    worst = std::max(worst, off);
  }
  return std::isfinite(gradient.scale) ? worst / gradient.scale : infinite;
}

}  // namespace detail

GONIO_INLINE scaled_gradient gradient_of(const normal_equations& normal, Eigen::Index right_hand_side,
                                         const Eigen::Ref<const Eigen::VectorXd>& x) {
  GONIO_ASSERT(x.size() == normal.unknowns());
  return detail::gradient_of(normal, right_hand_side, x.data());
}

GONIO_INLINE Eigen::VectorXd stationarity(const normal_equations& normal, const Eigen::MatrixXd& x) {
  Eigen::VectorXd violation(x.cols());
  for (Eigen::Index column = 0; column < x.cols(); ++column) {
    const scaled_gradient gradient = detail::gradient_of(normal, column, &x(0, column));
    double worst = 0.0;
    for (Eigen::Index j = 0; j < x.rows(); ++j)
      worst = std::max(worst, std::isfinite(gradient.value[j]) ? std::abs(gradient.value[j])
                                                               : std::numeric_limits<double>::infinity());
    violation[column] =
        std::isfinite(gradient.scale) ? worst / gradient.scale : std::numeric_limits<double>::infinity();
  }
  return violation;
}

GONIO_INLINE Eigen::VectorXd kkt_violation(const normal_equations& normal, const Eigen::MatrixXd& x, double lambda,
                                           sign_rule signs) {
  Eigen::VectorXd violation(x.cols());
  for (Eigen::Index column = 0; column < x.cols(); ++column)
    violation[column] =
        detail::kkt_violation(detail::gradient_of(normal, column, &x(0, column)), &x(0, column), lambda, signs);
  return violation;
}

}  // namespace gonio
