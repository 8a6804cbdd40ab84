#pragma once
/// Bodies of solve/row_active_set.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/solve/compensated.hpp>
#include <gonio/solve/householder_qr.hpp>
#include <gonio/solve/iteration.hpp>
#include <gonio/solve/row_active_set.hpp>
#include <gonio/solve/thin_product.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gonio {

namespace detail {

/// A column counts as a combination of other columns if its remainder is at most this share of its length.
inline constexpr double dependent_share = 3e-11;

}  // namespace detail

/// The optimum z of the passive columns A_P: A_P'(b - A_P z) equals the penalties with the signs of z. `misfit` is b -
/// A_P z.
struct row_active_set::passive_optimum {
  Eigen::VectorXd z, misfit;
  bool independent = false;
};

GONIO_INLINE row_active_set::row_active_set(Eigen::MatrixXd rows, Eigen::VectorXd right, double lambda, sign_rule signs)
    : columns_(std::move(rows)),
      right_(std::move(right)),
      unit_(columns_.cols()),
      penalty_(columns_.cols()),
      signs_(signs),
      barred_(columns_.cols(), false) {
  const Eigen::Index n = columns_.rows(), k = columns_.cols();
  const double inverse = near_inverse(norm(right_.data(), n));
  for (double& value : right_) value *= inverse;
  for (Eigen::Index j = 0; j < k; ++j) {
    unit_[j] = near_inverse(norm(&columns_(0, j), n));
    for (Eigen::Index i = 0; i < n; ++i) columns_(i, j) *= unit_[j];
    penalty_[j] = lambda * unit_[j] * inverse;
    unit_[j] /= inverse;
  }
  state_ = {{}, Eigen::VectorXd::Zero(k), Eigen::VectorXd::Zero(k), right_};
  choose_entering();
}

GONIO_INLINE Eigen::MatrixXd row_active_set::columns_of(const std::vector<Eigen::Index>& passive) const {
  Eigen::MatrixXd some(columns_.rows(), std::ssize(passive));
  for (Eigen::Index i = 0; i < some.cols(); ++i) std::copy_n(&columns_(0, passive[i]), some.rows(), &some(0, i));
  return some;
}

GONIO_INLINE void row_active_set::step() {
  const Eigen::Index entering = entering_;
  const state before = state_;
  const Eigen::VectorXd descent = descent_;
  state_.sign[entering] = descent_[entering] > 0.0 ? 1.0 : -1.0;
  if (enter(entering) && change_since(before, descent) < 0.0) {
    barred_.assign(barred_.size(), false);
  } else {
    state_ = before;
    barred_[entering] = true;
  }
  choose_entering();
}

GONIO_INLINE bool row_active_set::enter(Eigen::Index column) {
  const state before = state_;
  state_.passive.push_back(column);
  if (settle()) return true;
  state_ = before;
  return exchange(column);
}

/// Works like `active_set::exchange`, but on the rows.
GONIO_INLINE bool row_active_set::exchange(Eigen::Index column) {
  if (penalty_[column] == 0.0 || state_.passive.empty()) return false;
  const householder_qr qr(columns_of(state_.passive));
  Eigen::VectorXd entering = columns_.col(column);
  qr.apply_transposed(entering.data());
  qr.solve(entering.data());
  const Eigen::VectorXd combination = entering.head(qr.cols());
  const double sign = state_.sign[column];
  double length = std::numeric_limits<double>::infinity();
  std::ptrdiff_t first = -1;
  for (Eigen::Index i = 0; i < combination.size(); ++i) {
    const Eigen::Index j = state_.passive[i];
    const double shrinking = combination[i] * sign * state_.sign[j];
    if (!(shrinking > 0.0) || std::abs(state_.x[j]) / shrinking >= length) continue;
    length = std::abs(state_.x[j]) / shrinking;
    first = i;
  }
  if (first < 0) return false;
  for (Eigen::Index i = 0; i < combination.size(); ++i) state_.x[state_.passive[i]] -= length * sign * combination[i];
  drop(first);
  state_.passive.push_back(column);
  state_.x[column] = length * sign;
  return settle();
}

GONIO_INLINE void row_active_set::drop(std::ptrdiff_t position) {
  const auto dropped = state_.passive.begin() + position;
  state_.x[*dropped] = state_.sign[*dropped] = 0.0;
  state_.passive.erase(dropped);
}

GONIO_INLINE row_active_set::passive_optimum row_active_set::optimum() const {
  // Factorise the passive columns, and give up if they depend on each other.
  const Eigen::MatrixXd columns = columns_of(state_.passive);
  const Eigen::Index n = columns.rows(), p = columns.cols();
  passive_optimum found{Eigen::VectorXd::Zero(p), Eigen::VectorXd::Zero(n)};
  if (p > n) return found;
  const householder_qr qr(columns);
  for (Eigen::Index i = 0; i < p; ++i)
    if (!(std::abs(qr.triangle(i, i)) > detail::dependent_share * qr.length(i))) return found;
  // Solve misfit + A_P z = b and A_P' misfit = penalties. Solve again for the residuals of both equations, computed in
  // twice the precision (Bjorck 1967).
  constexpr int refinements = 2;
  Eigen::VectorXd above(n), below(p), z(p);
  for (int round = 0; round <= refinements; ++round) {
    // Compute the residuals of both equations.
    for (Eigen::Index i = 0; i < n; ++i) {
      compensated_sum left(right_[i]);
      left.add(-found.misfit[i]);
      for (Eigen::Index j = 0; j < p; ++j) left.add_product(-columns(i, j), found.z[j]);
      above[i] = left.value();
    }
    for (Eigen::Index j = 0; j < p; ++j) {
      const Eigen::Index column = state_.passive[j];
      compensated_sum left(penalty_[column] * state_.sign[column]);
      for (Eigen::Index i = 0; i < n; ++i) left.add_product(-columns(i, j), found.misfit[i]);
      below[j] = left.value();
    }
    // Solve for the corrections by Q and R, and add them.
    qr.apply_transposed(above.data());
    qr.solve_transposed(below.data());
    for (Eigen::Index j = 0; j < p; ++j) z[j] = above[j] - below[j];
    qr.solve(z.data());
    std::copy_n(below.data(), p, above.data());
    qr.apply(above.data());
    add_scaled(1.0, z.data(), found.z.data(), p);
    add_scaled(1.0, above.data(), found.misfit.data(), n);
  }
  found.independent = std::all_of(found.z.begin(), found.z.end(), [](double weight) { return std::isfinite(weight); });
  return found;
}

GONIO_INLINE bool row_active_set::settle() {
  state_.misfit = right_;
  while (!state_.passive.empty()) {
    const passive_optimum best = optimum();
    if (!best.independent) return false;
    double length = 1.0;
    bool inside = true;
    for (Eigen::Index i = 0; i < best.z.size(); ++i) {
      const Eigen::Index j = state_.passive[i];
      if (best.z[i] * state_.sign[j] > 0.0) continue;
      inside = false;
      const double distance = std::abs(state_.x[j]) + std::abs(best.z[i]);
      length = std::min(length, distance > 0.0 ? std::abs(state_.x[j]) / distance : 0.0);
    }
    for (Eigen::Index i = 0; i < best.z.size(); ++i) {
      double& weight = state_.x[state_.passive[i]];
      weight = inside ? best.z[i] : weight + length * (best.z[i] - weight);
    }
    if (inside) {
      state_.misfit = best.misfit;
      return true;
    }
    for (std::ptrdiff_t i = best.z.size() - 1; i >= 0; --i) {
      const Eigen::Index j = state_.passive[i];
      const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(best.z[i]);
      if (best.z[i] * state_.sign[j] <= 0.0 && state_.x[j] * state_.sign[j] <= rounding) drop(i);
    }
  }
  return true;
}

GONIO_INLINE void row_active_set::choose_entering() {
  descent_ = thin_transposed_product(columns_, state_.misfit).col(0);
  const double norm = std::sqrt(dot(state_.misfit.data(), state_.misfit.data(), state_.misfit.size()));
  double best = 4 * std::numeric_limits<double>::epsilon() * norm;
  entering_ = -1;
  for (Eigen::Index j = 0; j < descent_.size(); ++j) {
    if (state_.sign[j] != 0.0 || barred_[j]) continue;
    const double slope = (signs_ == sign_rule::any ? std::abs(descent_[j]) : descent_[j]) - penalty_[j];
    if (slope <= best) continue;
    best = slope;
    entering_ = j;
  }
}

GONIO_INLINE double row_active_set::change_since(const state& before, const Eigen::VectorXd& descent) const {
  double change = 0.0;
  for (Eigen::Index i = 0; i < right_.size(); ++i) {
    const double moved = before.misfit[i] - state_.misfit[i];
    change += 0.5 * moved * moved;
  }
  for (Eigen::Index j = 0; j < descent.size(); ++j)
    change += penalty_[j] * (std::abs(state_.x[j]) - std::abs(before.x[j])) - descent[j] * (state_.x[j] - before.x[j]);
  return change;
}

}  // namespace gonio
