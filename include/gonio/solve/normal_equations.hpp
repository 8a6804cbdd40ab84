#pragma once
/// The normal equations of a least-squares problem: all that most solvers need.
/// Noell, Koehler and Stricker 2014, Eq. 9-10.

#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// The problem to minimise 1/2 x'Q x - m'x with Q = A'WA and m = A'Wb (c = -m in Eq. 10), for one or more right-hand
/// sides b.
///
/// Solvers accept normal equations in place of a `least_squares_problem`. The normal equations of some columns are a
/// submatrix, so leave-one-out problems never read the data again.
class normal_equations {
 public:
  /// `gram` is Q, k x k, symmetric and positive semidefinite; `rhs` is m, k x r; `rhs_squared_norm` has b'Wb of each
  /// right-hand side (zeros if empty: `residual` is then meaningless). Throws gonio::error if sizes do not match or are
  /// 0, if a number is not finite, or if a squared norm is negative; for a number, the message names the column. Does
  /// not check symmetry. O(k^2 + k r).
  normal_equations(Eigen::MatrixXd gram, Eigen::MatrixXd rhs, Eigen::VectorXd rhs_squared_norm = {});

  /// Returns Q, both triangles.
  [[nodiscard]] const Eigen::MatrixXd& gram() const noexcept { return gram_; }
  /// Returns m: k x r.
  [[nodiscard]] const Eigen::MatrixXd& rhs() const noexcept { return rhs_; }
  /// Returns b'Wb: r.
  [[nodiscard]] const Eigen::VectorXd& rhs_squared_norm() const noexcept { return rhs_squared_norm_; }

  [[nodiscard]] Eigen::Index unknowns() const noexcept { return gram_.rows(); }
  [[nodiscard]] Eigen::Index right_hand_sides() const noexcept { return rhs_.cols(); }
  [[nodiscard]] const normal_equations& normal() const noexcept { return *this; }

  /// Returns 1/2 x'Q x - m'x for each right-hand side. `x` has a column for each right-hand side. O(k^2 r).
  [[nodiscard]] Eigen::VectorXd objective(const Eigen::MatrixXd& x) const;

  /// Returns sqrt(x'Q x - 2 m'x + b'Wb), the weighted norm of A x - b. Cancellation hides residuals below about 1e-8 of
  /// |b|; compute such residuals from the rows of the problem.
  [[nodiscard]] Eigen::VectorXd residual(const Eigen::MatrixXd& x) const;

  /// Returns the normal equations of a problem that has the rows of both problems. Throws gonio::error if their sizes
  /// differ.
  friend normal_equations operator+(const normal_equations& a, const normal_equations& b);

  /// Returns the problem over some of the columns, in the given order: a submatrix.
  [[nodiscard]] normal_equations subset(std::span<const Eigen::Index> columns) const;

 private:
  [[nodiscard]] double quadratic_form(const Eigen::MatrixXd& x, Eigen::Index column) const;

  void require_consistent() const;

  Eigen::MatrixXd gram_;
  Eigen::MatrixXd rhs_;
  Eigen::VectorXd rhs_squared_norm_;
};

[[nodiscard]] normal_equations operator+(const normal_equations& a, const normal_equations& b);

/// Returns the problem of predicting column `target` of A from other columns of A, given the Gram matrix of A: b is
/// column `target`. With the Gram matrix of a whole basis, each leave-one-out problem costs O(k^2) for k columns and
/// reads no data.
[[nodiscard]] normal_equations leave_one_out(const Eigen::MatrixXd& gram, Eigen::Index target,
                                             std::span<const Eigen::Index> columns);

/// Returns the columns from 0 to k - 1 without column `omitted`.
[[nodiscard]] std::vector<Eigen::Index> all_but(Eigen::Index k, Eigen::Index omitted);

/// A problem for a solver that uses the normal equations alone.
template <class Problem>
concept quadratic_problem = requires(const Problem& problem, const Eigen::MatrixXd& x) {
  { problem.normal() } -> std::convertible_to<const normal_equations&>;
  { problem.residual(x) } -> std::same_as<Eigen::VectorXd>;
};

static_assert(quadratic_problem<normal_equations>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/normal_equations.ipp>
#endif
