#pragma once
/// Reduces and evaluates the rows of a least-squares problem without a Gram matrix, which would square their condition
/// number. Lawson and Hanson, Solving Least Squares Problems, 1974 (doi:10.1137/1.9781611971217), chapter 27 (rows
/// accumulated block by block).

#include <gonio/solve/kkt.hpp>
#include <gonio/solve/least_squares_problem.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio {

namespace detail {

/// Returns [W^(1/2) A, W^(1/2) b] multiplied by an orthogonal matrix from the left. Up to k + r rows, the result is the
/// matrix itself; for more rows, it is the triangle of its QR factorisation, (k + r) x (k + r). Stacks rows on the
/// triangle of the previous rows and factorises when the buffer is full, so a million rows need the memory of about a
/// thousand. About 2 n (k + r)^2 operations for n rows.
[[nodiscard]] Eigen::MatrixXd triangular_equations(const least_squares_problem& problem);

/// Returns the gradient A'W(A x - b) of each right-hand side, computed from the rows, for columns scaled to length 1.
/// Its scale is |b| + sum of |a_i| |x_i| over the columns a_i (all norms weighted by W); rounding leaves about 1e-16 of
/// it. Unlike `gradient_of`, needs no Gram matrix, and its scale does not vanish if b is orthogonal to the columns.
/// Reads the rows once: O(n k r).
[[nodiscard]] std::vector<scaled_gradient> gradients_of_rows(const least_squares_problem& problem,
                                                             const Eigen::MatrixXd& x);

/// Returns the distance of x from a stationary point of |W^(1/2) (A x - b)|^2, computed from the rows: the largest
/// entry of `gradients_of_rows`, relative to its scale. Unlike `stationarity`, needs no Gram matrix.
[[nodiscard]] Eigen::VectorXd stationarity_of_rows(const least_squares_problem& problem, const Eigen::MatrixXd& x);

}  // namespace detail

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/row_equations.ipp>
#endif
