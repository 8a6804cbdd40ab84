#pragma once
/// Bodies of solve/least_squares.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/dense.hpp>
#include <gonio/solve/least_squares.hpp>
#include <gonio/solve/symmetric_eigen.hpp>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace gonio {

namespace detail {

/// Returns norms by which columns can be divided: 1 instead of the norm of a column of zeros.
[[nodiscard]] GONIO_INLINE Eigen::VectorXd divisors(Eigen::VectorXd norms) {
  for (double& norm : norms)
    if (!(norm > 0.0)) norm = 1.0;
  return norms;
}

/// Multiplies each row of a matrix by its factor.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd scaled_rows(Eigen::MatrixXd matrix, const Eigen::VectorXd& factors) {
  for (Eigen::Index column = 0; column < matrix.cols(); ++column) matrix.col(column).array() *= factors.array();
  return matrix;
}

/// Returns the solution x of B x = `right` with the smallest norm, for independent rows of B. `transposed` is B', k x p
/// with p <= k.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd minimum_norm(const Eigen::MatrixXd& transposed, Eigen::MatrixXd right) {
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(transposed.rows(), right.cols());
  if (right.rows() == 0) return x;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(transposed);
  const Eigen::MatrixXd lower = qr.matrixQR().topRows(right.rows()).transpose();
  lower.triangularView<Eigen::Lower>().solveInPlace(right);
  x.topRows(right.rows()) = right;
  x.applyOnTheLeft(qr.householderQ());
  return x;
}

/// The matrix W^(1/2) [A D^-1, b], where D has the lengths of A's weighted columns, and the QR factorisation of W^(1/2)
/// A D^-1.
struct pivoted_rows {
  Eigen::VectorXd lengths;
  Eigen::MatrixXd right;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
};

[[nodiscard]] GONIO_INLINE pivoted_rows factorise_rows(const least_squares_problem& problem, double threshold) {
  const Eigen::MatrixXd equations = triangular_equations(problem);
  Eigen::MatrixXd left = equations.leftCols(problem.unknowns());
  pivoted_rows rows;
  rows.lengths = divisors(left.colwise().norm());
  for (Eigen::Index column = 0; column < left.cols(); ++column) left.col(column) *= 1.0 / rows.lengths[column];
  rows.right = equations.rightCols(problem.right_hand_side().cols());
  rows.qr.setThreshold(threshold);
  rows.qr.compute(left);
  return rows;
}

/// The spectrum of D^-1 Q D^-1 = V diag(values) V', where D^2 is the diagonal of Q, without the eigenvalues that count
/// as zero.
struct normal_spectrum {
  Eigen::VectorXd lengths;
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

[[nodiscard]] GONIO_INLINE normal_spectrum factorise_normal(const normal_equations& normal, double threshold) {
  normal_spectrum kept;
  kept.lengths = divisors(normal.gram().diagonal().cwiseSqrt());
  const Eigen::VectorXd inverse = kept.lengths.cwiseInverse();
  Eigen::MatrixXd scaled = normal.gram();
  for (Eigen::Index column = 0; column < scaled.cols(); ++column)
    for (Eigen::Index row = 0; row < scaled.rows(); ++row) scaled(row, column) *= inverse[row] * inverse[column];
  const symmetric_eigen eigen = decompose_symmetric(scaled, "normal equations");  // ascending
  const double relative = std::max(threshold, least_squares::gram_threshold);
  const double least = relative * relative * eigen.values[eigen.values.size() - 1];
  Eigen::Index rank = 0;
  for (const double value : eigen.values) rank += value > least ? 1 : 0;
  kept.values = eigen.values.tail(rank);
  kept.vectors = eigen.vectors.rightCols(rank);
  return kept;
}

}  // namespace detail

GONIO_INLINE least_squares::least_squares(double rank_threshold) : threshold_(rank_threshold) {
  if (!(rank_threshold >= 0.0 && rank_threshold < 1.0))
    refuse({"the rank threshold of a least-squares solver must be at least 0 and less than 1, not ", rank_threshold});
}

GONIO_INLINE Eigen::Index least_squares::rank(const least_squares_problem& problem) const {
  return detail::factorise_rows(problem, threshold_).qr.rank();
}

GONIO_INLINE Eigen::Index least_squares::rank(const normal_equations& normal) const {
  return detail::factorise_normal(normal, threshold_).values.size();
}

GONIO_INLINE solution least_squares::solve(const least_squares_problem& problem) const {
  // Factorise the scaled rows with column pivoting, Q R P, and keep as many rows of R as the rank.
  auto [lengths, right, qr] = detail::factorise_rows(problem, threshold_);
  const Eigen::Index rank = qr.rank();
  right.applyOnTheLeft(qr.householderQ().adjoint());
  const Eigen::MatrixXd triangle = qr.matrixR().topRows(rank).triangularView<Eigen::Upper>();
  const Eigen::MatrixXd kept = right.topRows(rank);

  solution found;
  // Solve the triangular system. If columns depend on each other, find the solution of the smallest norm.
  if (rank == problem.unknowns()) {
    const Eigen::MatrixXd scaled = triangle.triangularView<Eigen::Upper>().solve(kept);
    found.weights = detail::scaled_rows(qr.colsPermutation() * scaled, lengths.cwiseInverse());
  } else {
    const Eigen::MatrixXd transposed = triangle.transpose();
    found.weights = detail::minimum_norm(detail::scaled_rows(qr.colsPermutation() * transposed, lengths), kept);
  }
  // Compute the residual from the rows.
  found.report.residual = problem.residual(found.weights);
  // Compute 1/2 x'Qx - m'x as half the difference of two squares. The terms of the formula itself cancel if x is large.
  found.report.objective.resize(found.report.residual.size());
  for (Eigen::Index column = 0; column < found.report.residual.size(); ++column)
    found.report.objective[column] = 0.5 * (found.report.residual[column] * found.report.residual[column] -
                                            problem.right_hand_side().col(column).cwiseAbs2().dot(problem.weights()));
  // Compute the KKT residual from the rows. Throw if the weights fit worse than zero weights.
  found.report.kkt_residual = detail::stationarity_of_rows(problem, found.weights);
  for (Eigen::Index column = 0; column < found.report.objective.size(); ++column) {
    const double residual = found.report.residual[column];
    if (!(found.report.objective[column] <= 1e-9 * (0.5 * residual * residual - found.report.objective[column])))
      refuse(
          "least-squares weights fit worse than zero weights: the columns are too ill-conditioned for double "
          "precision; a larger rank threshold drops dependent columns");
  }
  return found;
}

GONIO_INLINE solution least_squares::solve(const normal_equations& normal) const {
  const auto [lengths, values, vectors] = detail::factorise_normal(normal, threshold_);
  const Eigen::MatrixXd rhs = detail::scaled_rows(normal.rhs(), lengths.cwiseInverse());
  const Eigen::MatrixXd kept = detail::scaled_rows(product(vectors.transpose(), rhs), values.cwiseInverse());

  solution found;
  if (values.size() == normal.unknowns())
    found.weights = detail::scaled_rows(product(vectors, kept), lengths.cwiseInverse());
  else
    found.weights = detail::minimum_norm(detail::scaled_rows(vectors, lengths), kept);
  found.report.residual = normal.residual(found.weights);
  found.report.objective = normal.objective(found.weights);
  found.report.kkt_residual = stationarity(normal, found.weights);
  return found;
}

}  // namespace gonio
