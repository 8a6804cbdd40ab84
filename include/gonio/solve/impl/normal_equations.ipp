#pragma once
/// Bodies of solve/normal_equations.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/normal_equations.hpp>
#include <gonio/solve/vector_kernels.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE normal_equations::normal_equations(Eigen::MatrixXd gram, Eigen::MatrixXd moment, Eigen::VectorXd energy)
    : gram_(std::move(gram)), moment_(std::move(moment)), energy_(std::move(energy)) {
  if (energy_.size() == 0) energy_ = Eigen::VectorXd::Zero(moment_.cols());
  require_consistent();
}

GONIO_INLINE Eigen::VectorXd normal_equations::objective(const Eigen::MatrixXd& x) const {
  Eigen::VectorXd values(x.cols());
  for (Eigen::Index column = 0; column < x.cols(); ++column)
    values[column] = 0.5 * quadratic_form(x, column) - dot(&moment_(0, column), &x(0, column), x.rows());
  return values;
}

GONIO_INLINE Eigen::VectorXd normal_equations::residual(const Eigen::MatrixXd& x) const {
  Eigen::VectorXd norms = objective(x);
  for (Eigen::Index column = 0; column < norms.size(); ++column)
    norms[column] = std::sqrt(std::max(2.0 * norms[column] + energy_[column], 0.0));
  return norms;
}

GONIO_INLINE normal_equations operator+(const normal_equations& a, const normal_equations& b) {
  if (a.unknowns() != b.unknowns() || a.right_hand_sides() != b.right_hand_sides())
    throw error{"normal equations of ",      a.unknowns(), " unknowns and ", a.right_hand_sides(),
                " right-hand sides and of ", b.unknowns(), " and ",          b.right_hand_sides(),
                " cannot be added"};
  Eigen::MatrixXd gram = a.gram_, moment = a.moment_;
  Eigen::VectorXd energy = a.energy_;
  add_scaled(1.0, b.gram_.data(), gram.data(), gram.size());
  add_scaled(1.0, b.moment_.data(), moment.data(), moment.size());
  add_scaled(1.0, b.energy_.data(), energy.data(), energy.size());
  return {std::move(gram), std::move(moment), std::move(energy)};
}

GONIO_INLINE normal_equations normal_equations::subset(std::span<const Eigen::Index> columns) const {
  const auto k = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd gram(k, k), moment(k, right_hand_sides());
  for (Eigen::Index j = 0; j < k; ++j) {
    const Eigen::Index from = columns[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < k; ++i) gram(i, j) = gram_(columns[static_cast<std::size_t>(i)], from);
    for (Eigen::Index r = 0; r < moment.cols(); ++r) moment(j, r) = moment_(from, r);
  }
  return {std::move(gram), std::move(moment), energy_};
}

GONIO_INLINE double normal_equations::quadratic_form(const Eigen::MatrixXd& x, Eigen::Index column) const {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < unknowns(); ++j)
    if (x(j, column) != 0.0) sum += x(j, column) * dot(&gram_(0, j), &x(0, column), x.rows());
  return sum;
}

GONIO_INLINE void normal_equations::require_consistent() const {
  if (gram_.size() == 0 || moment_.cols() == 0)
    throw error{"normal equations of ", gram_.rows(), " unknowns and ", moment_.cols(), " right-hand sides are empty"};
  if (gram_.rows() != gram_.cols() || moment_.rows() != gram_.rows() || energy_.size() != moment_.cols())
    throw error{"normal equations do not match in size: the Gram matrix is ",
                gram_.rows(),
                " x ",
                gram_.cols(),
                ", the moment ",
                moment_.rows(),
                " x ",
                moment_.cols(),
                ", and ",
                energy_.size(),
                " right-hand sides have their energy"};
  for (Eigen::Index column = 0; column < gram_.cols(); ++column) {
    bool finite = true;
    for (Eigen::Index row = 0; row < gram_.rows(); ++row) finite = finite && std::isfinite(gram_(row, column));
    for (Eigen::Index r = 0; r < moment_.cols(); ++r) finite = finite && std::isfinite(moment_(column, r));
    if (!finite) throw error{"column ", column, " of normal equations is not finite"};
    if (gram_(column, column) < 0.0)
      throw error{"column ", column, " of normal equations has the squared norm ", gram_(column, column),
                  ": it cannot be negative"};
  }
  for (Eigen::Index r = 0; r < energy_.size(); ++r)
    if (!std::isfinite(energy_[r])) throw error("the right-hand side of normal equations is not finite");
}

GONIO_INLINE normal_equations leave_one_out(const Eigen::MatrixXd& gram, Eigen::Index target,
                                            std::span<const Eigen::Index> columns) {
  Eigen::MatrixXd moment(gram.rows(), 1);
  std::copy_n(&gram(0, target), gram.rows(), moment.data());
  Eigen::VectorXd energy(1);
  energy[0] = gram(target, target);
  return normal_equations(gram, std::move(moment), std::move(energy)).subset(columns);
}

GONIO_INLINE std::vector<Eigen::Index> all_but(Eigen::Index k, Eigen::Index left_out) {
  std::vector<Eigen::Index> columns;
  columns.reserve(static_cast<std::size_t>(k));
  for (Eigen::Index column = 0; column < k; ++column)
    if (column != left_out) columns.push_back(column);
  return columns;
}

}  // namespace gonio
