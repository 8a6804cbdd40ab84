#pragma once
/// What the rows of a least-squares problem say without a Gram matrix, which would square their condition number.
/// Lawson and Hanson, Solving Least Squares Problems, 1974 (doi:10.1137/1.9781611971217), chapter 27 (rows accumulated
/// block by block).

#include <gonio/solve/kkt.hpp>
#include <gonio/solve/least_squares_problem.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio {

namespace detail {

/// [W^(1/2) A, W^(1/2) b] multiplied by an orthogonal matrix from the left: as it is if it has at most k + r rows, else
/// the triangle of its QR factorisation, (k + r) x (k + r). Rows are stacked on the triangle of the rows before, and
/// factorised when the buffer is full, so that a million rows need the memory of about a thousand. 2 n (k + r)^2
/// operations or a little more.
[[nodiscard]] Eigen::MatrixXd triangular_equations(const least_squares_problem& problem);

/// The gradient A'W(A x - b) of each right-hand side from the rows, in columns of length 1, relative to
/// |b| + sum of |a_i| |x_i| over the columns a_i (all norms weighted by W), of which rounding alone leaves about 1e-16.
/// It is `gradient_of` without a Gram matrix, on a scale that does not vanish when b is orthogonal to the columns.
/// Reads the rows once: O(n k r).
[[nodiscard]] std::vector<scaled_gradient> gradients_of_rows(const least_squares_problem& problem,
                                                             const Eigen::MatrixXd& x);

/// How far x is from a stationary point of |W^(1/2) (A x - b)|^2, from the rows: the largest entry of its gradient as
/// above. `stationarity` without a Gram matrix.
[[nodiscard]] Eigen::VectorXd stationarity_of_rows(const least_squares_problem& problem, const Eigen::MatrixXd& x);

}  // namespace detail

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/row_equations.ipp>
#endif
