#pragma once
/// Bodies of solve/linear_constraints.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/kkt.hpp>
#include <gonio/solve/linear_constraints.hpp>
#include <gonio/solve/normal_equations.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <string>
#include <type_traits>

namespace gonio {

GONIO_INLINE void linear_constraints::require_consistent(Eigen::Index unknowns) const {
  require_consistent(D, d, unknowns, "inequality");
  require_consistent(E, e, unknowns, "equality");
}

GONIO_INLINE linear_constraints linear_constraints::operator()(Eigen::Index unknowns) const {
  require_consistent(unknowns);
  return *this;
}

GONIO_INLINE void linear_constraints::require_consistent(const Eigen::MatrixXd& rows, const Eigen::VectorXd& right,
                                                         Eigen::Index unknowns, const std::string& kind) {
  if (rows.rows() != right.size())
    refuse({rows.rows(), " rows of ", kind, " constraints have ", right.size(), " right-hand values"});
  if (rows.rows() > 0 && rows.cols() != unknowns)
    refuse({"row 0 of the ", kind, " constraints has ", rows.cols(), " coefficients for ", unknowns, " unknowns"});
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    for (Eigen::Index column = 0; column < rows.cols(); ++column)
      if (!std::isfinite(rows(row, column)))
        refuse({"row ", row, " of the ", kind, " constraints is not finite in column ", column});
    if (!std::isfinite(right[row]))
      refuse({"row ", row, " of the ", kind, " constraints is not finite on its right-hand side"});
  }
}

GONIO_INLINE linear_constraints convex_weights::operator()(Eigen::Index unknowns) const {
  return {.E = Eigen::MatrixXd::Ones(1, unknowns), .e = Eigen::VectorXd::Ones(1), .non_negative = true};
}

}  // namespace gonio

namespace gonio::detail {

GONIO_INLINE double judged_row::relative_slack(double bound, double size) const {
  const double scale = std::abs(bound) + largest * size;
  return scale > 0.0 ? (bound - activity) / scale : 0.0;
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE Eigen::VectorXd column_lengths(const normal_equations& normal, const linear_constraints& constraints) {
  const Eigen::VectorXd norms = normal.gram().diagonal().cwiseSqrt();
  Eigen::VectorXd lengths = norms;
  const auto raise_for_zeros = [&](const auto& row) {
    double curved = 0.0, any = 0.0;
    for (Eigen::Index j = 0; j < norms.size(); ++j) {
      any = std::max(any, std::abs(row[j]));
      if (norms[j] > 0.0) curved = std::max(curved, std::abs(row[j]) / norms[j]);
    }
    const double largest = curved > 0.0 ? curved : any;
    for (Eigen::Index j = 0; j < norms.size(); ++j)
      if (norms[j] == 0.0 && largest > 0.0) lengths[j] = std::max(lengths[j], std::abs(row[j]) / largest);
  };
  for (Eigen::Index i = 0; i < constraints.d.size(); ++i) raise_for_zeros(constraints.D.row(i));
  for (Eigen::Index i = 0; i < constraints.e.size(); ++i) raise_for_zeros(constraints.E.row(i));
  for (double& length : lengths)
    if (length == 0.0) length = 1.0;
  return lengths;
}

}  // namespace gonio

namespace gonio::detail {

GONIO_INLINE judged_row::judged_row(const Eigen::VectorXd& row, const Eigen::VectorXd& lengths,
                                    const Eigen::Ref<const Eigen::VectorXd>& x) {
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    activity += row[j] * x[j];
    largest = std::max(largest, std::abs(row[j]) / lengths[j]);
  }
}

GONIO_INLINE scaled_gradient lagrangian_gradient(const normal_equations& normal, Eigen::Index right_hand_side,
                                                 const Eigen::Ref<const Eigen::VectorXd>& x,
                                                 const linear_constraints& constraints,
                                                 const constraint_multipliers& multipliers) {
  Eigen::VectorXd sum = -normal.rhs().col(right_hand_side), terms = sum.cwiseAbs();
  const auto add = [&](double factor, const auto& column) {
    if (factor == 0.0) return;
    sum += factor * column;
    terms += std::abs(factor) * column.cwiseAbs();
  };
  for (Eigen::Index i = 0; i < x.size(); ++i) add(x[i], normal.gram().col(i));
  for (Eigen::Index i = 0; i < constraints.d.size(); ++i)
    add(multipliers.inequality[i], constraints.D.row(i).transpose());
  for (Eigen::Index i = 0; i < constraints.e.size(); ++i)
    add(multipliers.equality[i], constraints.E.row(i).transpose());
  const Eigen::VectorXd lengths = column_lengths(normal, constraints);
  double scale = terms.cwiseQuotient(lengths).maxCoeff();
  // If only columns of zeros have weights, all terms are zero, and rounding errors would be compared with rounding
  // errors: compare with the weights instead. (A linear program has terms.)
  const bool linear = normal.gram().diagonal().maxCoeff() == 0.0 && !normal.rhs().col(right_hand_side).isZero(0.0);
  if (!linear) scale = std::max(scale, x.cwiseAbs().cwiseProduct(lengths).maxCoeff());
  return {sum.cwiseQuotient(lengths), scale > 0.0 ? scale : 1.0, lengths};
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE double kkt_violation(const normal_equations& normal, Eigen::Index right_hand_side,
                                  const Eigen::Ref<const Eigen::VectorXd>& x, const linear_constraints& constraints,
                                  const constraint_multipliers& multipliers) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const scaled_gradient gradient = detail::lagrangian_gradient(normal, right_hand_side, x, constraints, multipliers);
  if (!x.allFinite() || !gradient.value.allFinite() || !std::isfinite(gradient.scale)) return infinite;
  double worst = 0.0, size = 0.0;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    if (constraints.non_negative && x[j] < 0.0) return infinite;
    const bool at_bound = constraints.non_negative && x[j] == 0.0;
    worst = std::max(worst, (at_bound ? -gradient.value[j] : std::abs(gradient.value[j])) / gradient.scale);
    size = std::max(size, std::abs(x[j]) * gradient.column_norms[j]);
  }
  for (Eigen::Index i = 0; i < constraints.d.size(); ++i) {
    const detail::judged_row row(constraints.D.row(i).transpose(), gradient.column_norms, x);
    const double slack = row.relative_slack(constraints.d[i], size);
    if (!std::isfinite(slack)) return infinite;  // after an overflow, which std::max would ignore as NaN
    const double multiplier = multipliers.inequality[i] * row.largest / gradient.scale;
    worst = std::max({worst, -slack, -multiplier, std::min(multiplier, slack)});
  }
  for (Eigen::Index i = 0; i < constraints.e.size(); ++i) {
    const detail::judged_row row(constraints.E.row(i).transpose(), gradient.column_norms, x);
    const double slack = row.relative_slack(constraints.e[i], size);
    if (!std::isfinite(slack)) return infinite;
    worst = std::max(worst, std::abs(slack));
  }
  return worst;
}

}  // namespace gonio
