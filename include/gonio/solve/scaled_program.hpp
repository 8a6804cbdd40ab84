#pragma once
/// A quadratic program in units that make its numbers comparable.

#include <gonio/solve/linear_constraints.hpp>
#include <gonio/solve/normal_equations.hpp>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace gonio {

/// Which inequalities hold with equality: where a solver starts, and what it found.
struct active_constraints {
  std::vector<bool> bounds;  ///< of each weight: x_j = 0; empty for none
  std::vector<bool> rows;    ///< of each row of D; empty for none
};

/// min 1/2 y'G y - q'y subject to n_i'y = b_i for the first `equalities` rows n_i, n_i'y >= b_i for the others, and, if
/// `non_negative`, y >= 0. It is the program of normal equations in y = S x, with powers of two in the diagonal matrix
/// S near the `column_lengths`, and each row by one that brings its largest coefficient to [1/2, 1): nothing is
/// rounded. The diagonal of G is in [1/4, 1), or zero. A template only so that nobody pays for compiling it who does
/// not use it.
template <class Scalar = double>
struct scaled_program {
  using vector = Eigen::VectorX<Scalar>;

  scaled_program(const normal_equations& normal, const linear_constraints& constraints)
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

  [[nodiscard]] Eigen::Index unknowns() const noexcept { return G.rows(); }
  [[nodiscard]] Eigen::Index rows() const noexcept { return b.size(); }

  /// q of one right-hand side.
  [[nodiscard]] vector moment(const normal_equations& normal, Eigen::Index right_hand_side) const {
    return normal.moment().col(right_hand_side).cwiseProduct(inverse_scale);
  }
  /// x of y.
  [[nodiscard]] vector weights(const vector& y) const { return y.cwiseProduct(inverse_scale); }
  /// The multipliers of the constraints as they were given.
  [[nodiscard]] constraint_multipliers multipliers(const vector& of_rows) const {
    const vector unscaled = of_rows.cwiseProduct(inverse_row_scale);
    return {unscaled.tail(rows() - equalities), -unscaled.head(equalities)};
  }

  Eigen::Index equalities;
  bool non_negative;
  vector inverse_scale, inverse_row_scale;  ///< 1 / S_jj, and what multiplies each row
  Eigen::MatrixX<Scalar> G;
  Eigen::MatrixX<Scalar> normals;  ///< k x rows, n_i in column i
  vector b;

 private:
  /// A power of two that brings a positive length to [1/2, 1).
  [[nodiscard]] static Scalar near_inverse(Scalar length) { return std::ldexp(Scalar(1), -(std::ilogb(length) + 1)); }

  void set_row(Eigen::Index i, const vector& row, Scalar right) {
    normals.col(i) = row.cwiseProduct(inverse_scale);
    const Scalar largest = normals.col(i).cwiseAbs().maxCoeff();
    inverse_row_scale[i] = largest > 0 ? near_inverse(largest) : Scalar(1);
    normals.col(i) *= inverse_row_scale[i];
    b[i] = right * inverse_row_scale[i];
  }
};

}  // namespace gonio
