#pragma once
/// Bodies of solve/truncated_svd.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/dense.hpp>
#include <gonio/solve/symmetric_eigen.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace gonio {

namespace detail {

/// The squares of the singular values that are kept, ascending, and their left or right singular vectors.
struct kept_spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

[[nodiscard]] GONIO_INLINE kept_spectrum truncate_spectrum(const Eigen::MatrixXd& gram, double share) {
  if (gram.size() == 0) return {};  // all rows have weight zero
  const symmetric_eigen eigen = decompose_symmetric(gram, "a least-squares problem");
  const Eigen::VectorXd values = eigen.values.cwiseMax(0.0);
  const Eigen::Index all = values.size();
  const double rounding = static_cast<double>(all) * std::numeric_limits<double>::epsilon();
  const double enough = share * (1.0 - rounding) * values.sum();
  Eigen::Index kept = 0;
  for (double sum = 0.0; kept < all && sum < enough; ++kept) sum += values[all - 1 - kept];
  return {values.tail(kept), eigen.vectors.rightCols(kept)};
}

/// Returns Q and R of the QR factorisation of some columns: an orthonormal basis of the columns, and a triangle.
[[nodiscard]] GONIO_INLINE std::pair<Eigen::MatrixXd, Eigen::MatrixXd> thin_qr(const Eigen::MatrixXd& columns) {
  const Eigen::Index k = columns.rows(), p = columns.cols();
  if (p == 0) return {Eigen::MatrixXd(k, 0), Eigen::MatrixXd(0, 0)};
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(k, p);
  basis.applyOnTheLeft(qr.householderQ());
  return {std::move(basis), qr.matrixQR().topRows(p)};
}

/// Returns the largest magnitude divided by `scale`. Returns 0 if there are no numbers, and infinity after an overflow,
/// because std::max would ignore NaN.
[[nodiscard]] GONIO_INLINE double relative_violation(const Eigen::MatrixXd& violation, double scale) {
  if (violation.size() == 0) return 0.0;
  if (!violation.allFinite() || !std::isfinite(scale)) return std::numeric_limits<double>::infinity();
  return violation.lpNorm<Eigen::Infinity>() / (scale > 0.0 ? scale : 1.0);
}

/// A solution in a subspace, without its residual.
struct subspace_solution {
  const Eigen::MatrixXd& x;
  const Eigen::MatrixXd& rhs;              ///< A'Wb
  const Eigen::MatrixXd& basis;            ///< orthonormal basis V of the subspace
  const Eigen::MatrixXd& projected_image;  ///< A'WA x
  const Eigen::MatrixXd& span;             ///< A'WA V
  double largest = 0.0;                    ///< largest eigenvalue of A'WA

  [[nodiscard]] solution judged() const {
    const double led_out = relative_violation(outside(span), largest);
    const Eigen::MatrixXd gradient = product(basis.transpose(), projected_image - rhs), away = outside(x);
    solution found{x, {Eigen::VectorXd(x.cols()), Eigen::VectorXd(x.cols()), Eigen::VectorXd(x.cols())}};
    for (Eigen::Index column = 0; column < x.cols(); ++column) {
      const double norm = x.col(column).norm();
      found.report.objective[column] = x.col(column).dot(0.5 * projected_image.col(column) - rhs.col(column));
      found.report.kkt_residual[column] =
          std::max({led_out, relative_violation(gradient.col(column), rhs.col(column).norm() + largest * norm),
                    relative_violation(away.col(column), norm)});
    }
    return found;
  }

 private:
  /// Returns the part of each column that is outside of the subspace.
  [[nodiscard]] Eigen::MatrixXd outside(const Eigen::MatrixXd& columns) const {
    return columns - product(basis, product(basis.transpose(), columns));
  }
};

[[nodiscard]] GONIO_INLINE solution solve_truncated_dual(const least_squares_problem& problem, double share) {
  const Eigen::MatrixXd rows = problem.weighted_rows(), columns = rows.transpose();
  const auto [values, vectors] = truncate_spectrum(product_with_transpose(rows), share);
  // Solve the kept equations U'A x = U'b for the smallest norm through the QR factorisation of A'U. Division by the
  // eigenvalues would lose about half of the digits if the eigenvalues differ much.
  const auto [basis, triangle] = thin_qr(product(columns, vectors));
  const Eigen::MatrixXd right = problem.weighted_right_hand_side();
  Eigen::MatrixXd within = product(vectors.transpose(), right);
  triangle.transpose().triangularView<Eigen::Lower>().solveInPlace(within);
  const Eigen::MatrixXd x = product(basis, within), rhs = product(columns, right),
                        projected_image = product(columns, product(rows, x)),
                        span = product(columns, product(rows, basis));
  const double largest = values.size() > 0 ? values[values.size() - 1] : 0.0;
  return subspace_solution{x, rhs, basis, projected_image, span, largest}.judged();
}

[[nodiscard]] inline bool is_wide(const least_squares_problem& problem) {
  return problem.equations() < problem.unknowns();
}

}  // namespace detail

GONIO_INLINE truncated_svd::truncated_svd(double explained_variance) : share_(explained_variance) {
  if (!(explained_variance > 0.0 && explained_variance <= 1.0))
    refuse({"the explained variance of a truncated SVD must be above 0 and at most 1, not ", explained_variance});
}

GONIO_INLINE solution truncated_svd::solve(const least_squares_problem& problem) const {
  if (!detail::is_wide(problem)) return with_residual_of_rows(solve(problem.normal()), problem);
  solution found = detail::require_certified(detail::solve_truncated_dual(problem, share_), "the truncated SVD");
  return with_residual_of_rows(std::move(found), problem);
}

GONIO_INLINE solution truncated_svd::solve(const normal_equations& normal) const {
  const auto [values, vectors] = detail::truncate_spectrum(normal.gram(), share_);
  Eigen::MatrixXd within = product(vectors.transpose(), normal.rhs());
  for (Eigen::Index i = 0; i < values.size(); ++i) within.row(i) /= values[i];
  const Eigen::MatrixXd x = product(vectors, within), projected_image = product(normal.gram(), x),
                        span = product(normal.gram(), vectors);
  const double largest = values.size() > 0 ? values[values.size() - 1] : 0.0;
  solution found = detail::subspace_solution{x, normal.rhs(), vectors, projected_image, span, largest}.judged();
  found.report.residual = normal.residual(x);
  return detail::require_certified(std::move(found), "the truncated SVD");
}

GONIO_INLINE Eigen::Index truncated_svd::kept(const least_squares_problem& problem) const {
  if (!detail::is_wide(problem)) return kept(problem.normal());
  return detail::truncate_spectrum(product_with_transpose(problem.weighted_rows()), share_).values.size();
}

GONIO_INLINE Eigen::Index truncated_svd::kept(const normal_equations& normal) const {
  return detail::truncate_spectrum(normal.gram(), share_).values.size();
}

}  // namespace gonio
