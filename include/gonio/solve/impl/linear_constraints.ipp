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
  const auto text = [](Eigen::Index n) { return std::to_string(n); };
  if (rows.rows() != right.size())
    throw error(text(rows.rows()) + " rows of " + kind + " constraints have " + text(right.size()) +
                " right-hand values");
  if (rows.rows() > 0 && rows.cols() != unknowns)
    throw error("row 0 of the " + kind + " constraints has " + text(rows.cols()) + " coefficients for " +
                text(unknowns) + " unknowns");
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    for (Eigen::Index column = 0; column < rows.cols(); ++column)
      if (!std::isfinite(rows(row, column)))
        throw error("row " + text(row) + " of the " + kind + " constraints is not finite in column " + text(column));
    if (!std::isfinite(right[row]))
      throw error("row " + text(row) + " of the " + kind + " constraints is not finite on its right-hand side");
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
