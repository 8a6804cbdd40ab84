#pragma once
/// A quadratic program in units that make its numbers comparable.

#include <gonio/solve/linear_constraints.hpp>
#include <gonio/solve/normal_equations.hpp>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace gonio {

/// The inequalities that hold with equality. A solver starts from them and returns them.
struct active_constraints {
  std::vector<bool> bounds;  ///< for each weight, whether x_j = 0; empty for none
  std::vector<bool> rows;    ///< for each row of D; empty for none
};

/// The program min 1/2 y'G y - q'y subject to n_i'y = b_i for the first `equalities` rows n_i, n_i'y >= b_i for all
/// further rows, and, if `non_negative`, y >= 0. It is the program of normal equations in y = S x. The diagonal matrix
/// S has powers of two near the `column_lengths`. Each row is multiplied by a power of two that brings its largest
/// coefficient to [1/2, 1). Scaling by powers of two rounds nothing. The numbers on the diagonal of G are in [1/4, 1),
/// or zero.
struct scaled_program {
  using vector = Eigen::VectorXd;

  scaled_program(const normal_equations& normal, const linear_constraints& constraints);

  [[nodiscard]] Eigen::Index unknowns() const noexcept { return G.rows(); }
  [[nodiscard]] Eigen::Index rows() const noexcept { return b.size(); }

  /// Returns q of the scaled program for one right-hand side of the normal equations.
  [[nodiscard]] vector rhs(const normal_equations& normal, Eigen::Index right_hand_side) const {
    return normal.rhs().col(right_hand_side).cwiseProduct(inverse_scale);
  }
  /// Returns x, given y.
  [[nodiscard]] vector weights(const vector& y) const { return y.cwiseProduct(inverse_scale); }
  /// Returns the multipliers of the original constraints, given those of the scaled rows.
  [[nodiscard]] constraint_multipliers multipliers(const vector& of_rows) const;

  Eigen::Index equalities;
  bool non_negative;
  vector inverse_scale, inverse_row_scale;  ///< 1 / S_jj, and the factor of each row
  Eigen::MatrixXd G;
  Eigen::MatrixXd normals;  ///< k x rows, n_i in column i
  vector b;

 private:
  /// Returns the power of two that brings a positive length to [1/2, 1).
  [[nodiscard]] static double near_inverse(double length) { return std::ldexp(1.0, -(std::ilogb(length) + 1)); }

  void set_row(Eigen::Index i, const vector& row, double right);
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/scaled_program.ipp>
#endif
