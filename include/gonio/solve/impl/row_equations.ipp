#pragma once
/// Bodies of solve/row_equations.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/householder_qr.hpp>
#include <gonio/solve/row_equations.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

GONIO_INLINE Eigen::MatrixXd triangular_equations(const least_squares_problem& problem) {
  const Eigen::MatrixXd& right = problem.right_hand_side();
  const Eigen::Index k = problem.unknowns(), columns = k + right.cols();
  const Eigen::Index room = columns + std::max<Eigen::Index>(columns, 1024);
  Eigen::MatrixXd stacked(std::min(problem.equations(), room), columns);
  Eigen::Index filled = 0;
  const auto triangularise = [&] {
    if (filled <= columns) return;
    const householder_qr qr(stacked.topRows(filled));
    for (Eigen::Index column = 0; column < columns; ++column)
      for (Eigen::Index row = 0; row < columns; ++row)
        stacked(row, column) = row <= column ? qr.triangle(row, column) : 0.0;
    filled = columns;
  };
  problem.for_each_row_block([&](block range, const row_matrix& part) {
    for (Eigen::Index row = 0; row < part.rows(); ++row) {
      const Eigen::Index at = range.begin + row;
      if (filled == stacked.rows()) triangularise();
      const double root = std::sqrt(problem.weights()[at]);
      for (Eigen::Index j = 0; j < k; ++j) stacked(filled, j) = root * part(row, j);
      for (Eigen::Index j = k; j < columns; ++j) stacked(filled, j) = root * right(at, j - k);
      ++filled;
    }
  });
  triangularise();
  return stacked.topRows(filled);
}

GONIO_INLINE std::vector<scaled_gradient> gradients_of_rows(const least_squares_problem& problem,
                                                            const Eigen::MatrixXd& x) {
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(x.rows());
  problem.for_each_row_block([&](block range, const row_matrix& part) {
    for (Eigen::Index row = 0; row < part.rows(); ++row) {
      const Eigen::Index at = range.begin + row;
      const double weight = problem.weights()[at];
      const double* a = part.data() + row * part.cols();
      for (Eigen::Index column = 0; column < x.cols(); ++column) {
        const double misfit = dot(a, &x(0, column), part.cols()) - problem.right_hand_side()(at, column);
        add_scaled(weight * misfit, a, &gradient(0, column), part.cols());
      }
      for (Eigen::Index j = 0; j < part.cols(); ++j) squares[j] += weight * a[j] * a[j];
    }
  });
  Eigen::VectorXd norms(x.rows());
  for (Eigen::Index j = 0; j < x.rows(); ++j) norms[j] = squares[j] > 0.0 ? std::sqrt(squares[j]) : 1.0;
  std::vector<scaled_gradient> gradients;
  for (Eigen::Index column = 0; column < x.cols(); ++column) {
    double rhs_squared_norm = 0.0, reach = 0.0;
    for (Eigen::Index row = 0; row < problem.equations(); ++row)
      rhs_squared_norm += problem.weights()[row] * std::pow(problem.right_hand_side()(row, column), 2);
    for (Eigen::Index j = 0; j < x.rows(); ++j) {
      gradient(j, column) /= norms[j];
      reach += norms[j] * std::abs(x(j, column));
    }
    const double scale = std::sqrt(rhs_squared_norm) + reach;
    gradients.push_back({gradient.col(column), scale > 0.0 ? scale : 1.0, norms});
  }
  return gradients;
}

GONIO_INLINE Eigen::VectorXd stationarity_of_rows(const least_squares_problem& problem, const Eigen::MatrixXd& x) {
  Eigen::VectorXd violation(x.cols());
  Eigen::Index column = 0;
  for (const scaled_gradient& gradient : gradients_of_rows(problem, x)) {
    double largest = 0.0;
    for (const double entry : gradient.value)
      largest = std::isfinite(entry) ? std::max(largest, std::abs(entry)) : std::numeric_limits<double>::infinity();
    violation[column++] = largest / gradient.scale;
  }
  return violation;
}

}  // namespace detail

}  // namespace gonio
