#pragma once
/// Bodies of solve/normal_equations.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/normal_equations.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE normal_equations::normal_equations(Eigen::MatrixXd gram, Eigen::MatrixXd rhs,
                                                Eigen::VectorXd rhs_squared_norm)
    : gram_(std::move(gram)), rhs_(std::move(rhs)), rhs_squared_norm_(std::move(rhs_squared_norm)) {
  if (rhs_squared_norm_.size() == 0) rhs_squared_norm_ = Eigen::VectorXd::Zero(rhs_.cols());
  require_consistent();
}

GONIO_INLINE Eigen::VectorXd normal_equations::objective(const Eigen::MatrixXd& x) const {
  Eigen::VectorXd values(x.cols());
  for (Eigen::Index column = 0; column < x.cols(); ++column)
    values[column] = 0.5 * quadratic_form(x, column) - dot(&rhs_(0, column), &x(0, column), x.rows());
  return values;
}

GONIO_INLINE Eigen::VectorXd normal_equations::residual(const Eigen::MatrixXd& x) const {
  Eigen::VectorXd norms = objective(x);
  for (Eigen::Index column = 0; column < norms.size(); ++column)
    norms[column] = std::sqrt(std::max(2.0 * norms[column] + rhs_squared_norm_[column], 0.0));
  return norms;
}

GONIO_INLINE normal_equations operator+(const normal_equations& a, const normal_equations& b) {
  if (a.unknowns() != b.unknowns() || a.right_hand_sides() != b.right_hand_sides())
    refuse({"normal equations of ", b.unknowns(), " unknowns and ", b.right_hand_sides(),
            " right-hand sides cannot be added to normal equations of ", a.unknowns(), " unknowns and ",
            a.right_hand_sides(), " right-hand sides"});
  Eigen::MatrixXd gram = a.gram_, rhs = a.rhs_;
  Eigen::VectorXd rhs_squared_norm = a.rhs_squared_norm_;
  add_scaled(1.0, b.gram_.data(), gram.data(), gram.size());
  add_scaled(1.0, b.rhs_.data(), rhs.data(), rhs.size());
  add_scaled(1.0, b.rhs_squared_norm_.data(), rhs_squared_norm.data(), rhs_squared_norm.size());
  return {std::move(gram), std::move(rhs), std::move(rhs_squared_norm)};
}

GONIO_INLINE normal_equations normal_equations::subset(std::span<const Eigen::Index> columns) const {
  const Eigen::Index k = std::ssize(columns);
  Eigen::MatrixXd gram(k, k), rhs(k, right_hand_sides());
  for (Eigen::Index j = 0; j < k; ++j) {
    const Eigen::Index from = columns[j];
    for (Eigen::Index i = 0; i < k; ++i) gram(i, j) = gram_(columns[i], from);
    for (Eigen::Index r = 0; r < rhs.cols(); ++r) rhs(j, r) = rhs_(from, r);
  }
  return {std::move(gram), std::move(rhs), rhs_squared_norm_};
}

GONIO_INLINE double normal_equations::quadratic_form(const Eigen::MatrixXd& x, Eigen::Index column) const {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < unknowns(); ++j)
    if (x(j, column) != 0.0) sum += x(j, column) * dot(&gram_(0, j), &x(0, column), x.rows());
  return sum;
}

GONIO_INLINE void normal_equations::require_consistent() const {
  if (gram_.size() == 0 || rhs_.cols() == 0)
    refuse({"normal equations of ", gram_.rows(), " unknowns and ", rhs_.cols(), " right-hand sides are empty"});
  if (gram_.rows() != gram_.cols() || rhs_.rows() != gram_.rows() || rhs_squared_norm_.size() != rhs_.cols())
    refuse({"normal equations do not match in size: the Gram matrix is ", gram_.rows(), " x ", gram_.cols(),
            ", the right-hand sides are ", rhs_.rows(), " x ", rhs_.cols(), ", and there are ",
            rhs_squared_norm_.size(), " squared norms of right-hand sides"});
  for (Eigen::Index column = 0; column < gram_.cols(); ++column) {
    bool finite = true;
    for (Eigen::Index row = 0; row < gram_.rows(); ++row) finite = finite && std::isfinite(gram_(row, column));
    for (Eigen::Index r = 0; r < rhs_.cols(); ++r) finite = finite && std::isfinite(rhs_(column, r));
    if (!finite) refuse({"column ", column, " of normal equations is not finite"});
    if (gram_(column, column) < 0.0)
      refuse({"column ", column, " of normal equations has the squared norm ", gram_(column, column),
              ": it cannot be negative"});
  }
  for (Eigen::Index r = 0; r < rhs_squared_norm_.size(); ++r)
    if (!std::isfinite(rhs_squared_norm_[r])) refuse("the right-hand side of normal equations is not finite");
}

GONIO_INLINE normal_equations leave_one_out(const Eigen::MatrixXd& gram, Eigen::Index target,
                                            std::span<const Eigen::Index> columns) {
  Eigen::MatrixXd rhs(gram.rows(), 1);
  std::copy_n(&gram(0, target), gram.rows(), rhs.data());
  Eigen::VectorXd rhs_squared_norm(1);
  rhs_squared_norm[0] = gram(target, target);
  return normal_equations(gram, std::move(rhs), std::move(rhs_squared_norm)).subset(columns);
}

GONIO_INLINE std::vector<Eigen::Index> all_but(Eigen::Index k, Eigen::Index omitted) {
  std::vector<Eigen::Index> columns;
  columns.reserve(k);
  for (Eigen::Index column = 0; column < k; ++column)
    if (column != omitted) columns.push_back(column);
  return columns;
}

}  // namespace gonio
