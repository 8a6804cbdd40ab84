#pragma once
/// Bodies of solve/scaled_program.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/linear_constraints.hpp>
#include <gonio/solve/normal_equations.hpp>
#include <gonio/solve/scaled_program.hpp>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace gonio {

GONIO_INLINE scaled_program::scaled_program(const normal_equations& normal, const linear_constraints& constraints)
    : equalities(constraints.e.size()),
      non_negative(constraints.non_negative),
      inverse_scale(normal.unknowns()),
      inverse_row_scale(constraints.e.size() + constraints.d.size()),
      G(normal.gram()),
      normals(normal.unknowns(), inverse_row_scale.size()),
      b(inverse_row_scale.size()) {
  const vector lengths = column_lengths(normal, constraints);
  for (Eigen::Index j = 0; j < unknowns(); ++j) inverse_scale[j] = near_inverse(lengths[j]);
  for (Eigen::Index j = 0; j < unknowns(); ++j) G.col(j) = (inverse_scale[j] * G.col(j)).cwiseProduct(inverse_scale);
  for (Eigen::Index i = 0; i < rows(); ++i) {
    if (i < equalities)
      set_row(i, constraints.E.row(i).transpose(), constraints.e[i]);
    else
      set_row(i, -constraints.D.row(i - equalities).transpose(), -constraints.d[i - equalities]);
  }
}

GONIO_INLINE constraint_multipliers scaled_program::multipliers(const vector& of_rows) const {
  const vector unscaled = of_rows.cwiseProduct(inverse_row_scale);
  return {unscaled.tail(rows() - equalities), -unscaled.head(equalities)};
}

GONIO_INLINE void scaled_program::set_row(Eigen::Index i, const vector& row, double right) {
  normals.col(i) = row.cwiseProduct(inverse_scale);
  const double largest = normals.col(i).cwiseAbs().maxCoeff();
  inverse_row_scale[i] = largest > 0 ? near_inverse(largest) : 1.0;
  normals.col(i) *= inverse_row_scale[i];
  b[i] = right * inverse_row_scale[i];
}

}  // namespace gonio
