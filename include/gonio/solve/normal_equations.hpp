#pragma once
/// The normal equations of a least-squares problem, which most solvers need and nothing else.
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

/// Minimise 1/2 x'Q x - m'x with Q = A'WA and m = A'Wb (c = -m in Eq. 10), for one or more right-hand sides b.
///
/// It is a problem of its own: solvers take it in place of a `least_squares_problem`, and what concerns a subset of
/// the columns is a submatrix, so that leave-one-out problems never touch the data again.
class normal_equations {
 public:
  /// `gram` is Q, k x k, symmetric and positive semidefinite; `rhs` is m, k x r; `rhs_squared_norm` holds b'Wb of each
  /// right-hand side (zeros if empty: `residual` is then meaningless). Throws gonio::error if sizes do not match, there
  /// is nothing, or a number is not finite, naming the column. Symmetry is the caller's word. O(k^2 + k r).
  normal_equations(Eigen::MatrixXd gram, Eigen::MatrixXd rhs, Eigen::VectorXd rhs_squared_norm = {});

  /// Q, both triangles.
  [[nodiscard]] const Eigen::MatrixXd& gram() const noexcept { return gram_; }
  /// m: k x r.
  [[nodiscard]] const Eigen::MatrixXd& rhs() const noexcept { return rhs_; }
  /// b'Wb: r.
  [[nodiscard]] const Eigen::VectorXd& rhs_squared_norm() const noexcept { return rhs_squared_norm_; }

  [[nodiscard]] Eigen::Index unknowns() const noexcept { return gram_.rows(); }
  [[nodiscard]] Eigen::Index right_hand_sides() const noexcept { return rhs_.cols(); }
  [[nodiscard]] const normal_equations& normal() const noexcept { return *this; }

  /// 1/2 x'Q x - m'x for each right-hand side, given its x as a column. O(k^2 r).
  [[nodiscard]] Eigen::VectorXd objective(const Eigen::MatrixXd& x) const;

  /// sqrt(x'Q x - 2 m'x + b'Wb), the weighted norm of A x - b. Residuals below about 1e-8 of |b| drown in cancellation:
  /// the rows of the problem tell more.
  [[nodiscard]] Eigen::VectorXd residual(const Eigen::MatrixXd& x) const;

  /// The problem of the rows of both: of the same sizes, else gonio::error.
  friend normal_equations operator+(const normal_equations& a, const normal_equations& b);

  /// The problem over some of the columns, in the order given: a submatrix.
  [[nodiscard]] normal_equations subset(std::span<const Eigen::Index> columns) const;

 private:
  [[nodiscard]] double quadratic_form(const Eigen::MatrixXd& x, Eigen::Index column) const;

  void require_consistent() const;

  Eigen::MatrixXd gram_;
  Eigen::MatrixXd rhs_;
  Eigen::VectorXd rhs_squared_norm_;
};

[[nodiscard]] normal_equations operator+(const normal_equations& a, const normal_equations& b);

/// The problem "column `target` of a Gram matrix from the others": b = A e_target, over the columns given. With the
/// Gram matrix of a whole basis at hand, each leave-one-out problem is O(k^2) and touches no data.
[[nodiscard]] normal_equations leave_one_out(const Eigen::MatrixXd& gram, Eigen::Index target,
                                             std::span<const Eigen::Index> columns);

/// All columns 0 to k - 1 but one, as leaving it out needs them.
[[nodiscard]] std::vector<Eigen::Index> all_but(Eigen::Index k, Eigen::Index left_out);

/// What a solver that works on the normal equations alone needs of a problem.
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
