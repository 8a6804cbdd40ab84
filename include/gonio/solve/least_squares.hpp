#pragma once
/// Least squares without penalty or constraints, for problems of any rank: orthogonal factorisation, minimum norm.
/// Golub and Van Loan, Matrix Computations, 4th ed. 2013, 5.4-5.5 (QR with column pivoting, rank-deficient problems);
/// Lawson and Hanson, Solving Least Squares Problems, 1974, chapter 27 (rows accumulated block by block).

#include <gonio/solve/solver.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <string>

namespace gonio {

namespace detail {

/// [W^(1/2) A, W^(1/2) b] multiplied by an orthogonal matrix from the left: as it is if it has at most k + r rows, else
/// the triangle of its QR factorisation, (k + r) x (k + r). Rows are stacked on the triangle of the rows before, and
/// factorised when the buffer is full, so that a million rows need the memory of about a thousand. 2 n (k + r)^2
/// operations or a little more.
template <class Problem>
[[nodiscard]] Eigen::MatrixXd triangular_equations(const Problem& problem) {
  const Eigen::MatrixXd& right = problem.right_hand_side();
  const Eigen::Index k = problem.unknowns(), columns = k + right.cols();
  const Eigen::Index room = columns + std::max<Eigen::Index>(columns, 1024);
  Eigen::MatrixXd stacked(std::min(problem.equations(), room), columns);
  Eigen::Index filled = 0;
  const auto triangularise = [&] {
    if (filled <= columns) return;
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(stacked.topRows(filled));
    stacked.topRows(columns) = qr.matrixQR().topRows(columns).template triangularView<Eigen::Upper>();
    filled = columns;
  };
  problem.for_each_row_block([&](block range, const row_matrix& part) {
    for (Eigen::Index row = 0; row < part.rows(); ++row) {
      const Eigen::Index at = static_cast<Eigen::Index>(range.begin) + row;
      if (filled == stacked.rows()) triangularise();
      const double root = std::sqrt(problem.weights()[at]);
      stacked.row(filled).head(k) = root * part.row(row);
      stacked.row(filled).tail(right.cols()) = root * right.row(at);
      ++filled;
    }
  });
  triangularise();
  return stacked.topRows(filled);
}

/// The x of the smallest norm with B x = `right`, where the rows of B are independent, given B': k x p, p <= k.
template <class Matrix>
[[nodiscard]] Matrix minimum_norm(const Matrix& transposed, const Matrix& right) {
  Matrix x = Matrix::Zero(transposed.rows(), right.cols());
  if (right.rows() == 0) return x;
  const Eigen::HouseholderQR<Matrix> qr(transposed);
  const Matrix triangle = qr.matrixQR().topRows(right.rows());
  x.topRows(right.rows()) = triangle.template triangularView<Eigen::Upper>().transpose().solve(right);
  x.applyOnTheLeft(qr.householderQ());
  return x;
}

/// Norms of columns to divide by: 1 for a column of zeros.
[[nodiscard]] Eigen::VectorXd divisors(Eigen::VectorXd norms);

/// How far x is from a stationary point of |W^(1/2) (A x - b)|^2, from the rows: the largest |a_j'W(A x - b)| / |a_j|
/// over the columns a_j, relative to |b| + sum of |a_i| |x_i| (all norms weighted by W), of which rounding alone leaves
/// about 1e-16. It is `stationarity` without a Gram matrix, on a scale that does not vanish when b is orthogonal to
/// the columns. Reads the rows once: O(n k r).
template <class Problem>
[[nodiscard]] Eigen::VectorXd stationarity_of_rows(const Problem& problem, const Eigen::MatrixXd& x) {
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(x.rows());
  problem.for_each_row_block([&](block range, const row_matrix& part) {
    const auto begin = static_cast<Eigen::Index>(range.begin);
    const Eigen::VectorXd weights = problem.weights().segment(begin, part.rows());
    for (Eigen::Index column = 0; column < x.cols(); ++column) {
      Eigen::VectorXd misfit = part * x.col(column) - problem.right_hand_side().col(column).segment(begin, part.rows());
      misfit.array() *= weights.array();
      gradient.col(column) += part.transpose() * misfit;
    }
    for (Eigen::Index row = 0; row < part.rows(); ++row)
      squares += weights[row] * part.row(row).cwiseAbs2().transpose();
  });
  const Eigen::VectorXd norms = divisors(squares.cwiseSqrt());
  Eigen::VectorXd violation(x.cols());
  for (Eigen::Index column = 0; column < x.cols(); ++column) {
    const double energy = problem.right_hand_side().col(column).cwiseAbs2().dot(problem.weights());
    const double scale = std::sqrt(energy) + norms.dot(x.col(column).cwiseAbs());
    const double worst = gradient.col(column).cwiseQuotient(norms).cwiseAbs().maxCoeff();
    violation[column] = scale > 0.0 ? worst / scale : worst;
  }
  return violation;
}

}  // namespace detail

/// Minimises |W^(1/2) (A x - b)|^2; of all minimisers, the x of the smallest norm.
///
/// A problem that has rows is solved by orthogonal factorisation of W^(1/2) A and never through its Gram matrix, which
/// would square the condition number: Householder QR, a block of rows at a time if there are more than about a
/// thousand, then QR with column pivoting of the triangle that remains. The rank is decided with all columns scaled to
/// length 1, and hence does not depend on their units; the norm that is smallest is that of x itself. O(n k^2) tall,
/// O(n^2 k) wide.
///
/// Normal equations alone are solved by an eigendecomposition of Q scaled to unit diagonal, O(k^3). Rounding hides
/// there whatever is below about sqrt(epsilon) of the largest singular value: see `gram_threshold`.
///
/// The certificate is that all of the gradient vanishes, also where the rank was truncated: `stationarity` for normal
/// equations, and the same from the rows (relative to |b| + sum of |a_i| |x_i|) where there are rows. Truncation leaves
/// at most about its threshold there. That is far below 1e-9 by default where there are rows. For normal equations
/// alone it can be up to 1e-7, if the columns have singular values which Q cannot tell from zero: the certificate then
/// says how much of the gradient they hold, and only the rows can give a better solution.
class least_squares {
 public:
  /// Singular values of normal equations below this share of the largest are taken for zero, or below the rank
  /// threshold if that is more. Rounding leaves about 1e-16 times a few of the largest eigenvalue, the square of a
  /// singular value, in those that should be zero.
  static constexpr double gram_threshold = 1e-7;

  /// A column is taken for a linear combination of others if these say it to `rank_threshold` of its length. Throws
  /// gonio::error unless it is at least 0 and less than 1.
  explicit least_squares(double rank_threshold = 1e-12);

  [[nodiscard]] double rank_threshold() const noexcept { return threshold_; }

  /// Throws gonio::error if a row is not finite, naming it.
  template <quadratic_problem Problem = least_squares_problem>
  [[nodiscard]] solution solve(const Problem& problem) const {
    if constexpr (requires { problem.rows(); })
      return solve_rows(problem);
    else
      return solve_normal(problem);
  }

  /// How many columns are linearly independent, as `solve` counts them.
  template <quadratic_problem Problem = least_squares_problem>
  [[nodiscard]] Eigen::Index rank(const Problem& problem) const {
    if constexpr (requires { problem.rows(); })
      return factorise_rows(problem).qr.rank();
    else
      return factorise_normal(problem.normal()).values.size();
  }

 private:
  /// W^(1/2) [A, b] D^-1, where D scales the columns of A to length 1, and the QR factorisation of its left part.
  template <class Matrix>
  struct pivoted_rows {
    Eigen::VectorXd lengths;
    Matrix right;
    Eigen::ColPivHouseholderQR<Matrix> qr;
  };

  template <class Problem>
  [[nodiscard]] auto factorise_rows(const Problem& problem) const {
    const Eigen::MatrixXd equations = detail::triangular_equations(problem);
    Eigen::MatrixXd left = equations.leftCols(problem.unknowns());
    pivoted_rows<Eigen::MatrixXd> rows;
    rows.lengths = detail::divisors(left.colwise().norm());
    left = left * rows.lengths.cwiseInverse().asDiagonal();
    rows.right = equations.rightCols(problem.right_hand_side().cols());
    rows.qr.setThreshold(threshold_);
    rows.qr.compute(left);
    return rows;
  }

  template <class Problem>
  [[nodiscard]] solution solve_rows(const Problem& problem) const {
    auto [lengths, right, qr] = factorise_rows(problem);
    const Eigen::Index rank = qr.rank();
    right.applyOnTheLeft(qr.householderQ().adjoint());
    const Eigen::MatrixXd triangle = qr.matrixR().topRows(rank).template triangularView<Eigen::Upper>();
    const Eigen::MatrixXd kept = right.topRows(rank);

    solution found;
    if (rank == problem.unknowns()) {
      const Eigen::MatrixXd scaled = triangle.template triangularView<Eigen::Upper>().solve(kept);
      found.weights = lengths.cwiseInverse().asDiagonal() * (qr.colsPermutation() * scaled);
    } else {
      const Eigen::MatrixXd transposed = triangle.transpose();
      found.weights =
          detail::minimum_norm<Eigen::MatrixXd>(lengths.asDiagonal() * (qr.colsPermutation() * transposed), kept);
    }
    found.residual = problem.residual(found.weights);
    // 1/2 x'Qx - m'x as half the difference of two squares: the terms themselves cancel when x is large.
    const Eigen::VectorXd energy = problem.right_hand_side().cwiseAbs2().transpose() * problem.weights();
    found.objective = 0.5 * (found.residual.cwiseAbs2() - energy);
    found.certificate = detail::stationarity_of_rows(problem, found.weights);
    return found;
  }

  /// D^-1 Q D^-1 = V diag(values) V' with D^2 the diagonal of Q, without the eigenvalues that are taken for zero.
  struct spectrum {
    Eigen::VectorXd lengths;
    Eigen::VectorXd values;
    Eigen::MatrixXd vectors;
  };

  template <class Normal>
  [[nodiscard]] spectrum factorise_normal(const Normal& normal) const {
    spectrum kept;
    kept.lengths = detail::divisors(normal.gram().diagonal().cwiseSqrt());
    const Eigen::VectorXd inverse = kept.lengths.cwiseInverse();
    const Eigen::MatrixXd scaled = normal.gram().cwiseProduct(inverse * inverse.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
    if (eigen.info() != Eigen::Success) throw error("the eigenvalues of normal equations do not converge");
    const Eigen::VectorXd& values = eigen.eigenvalues();  // ascending
    const double relative = std::max(threshold_, gram_threshold);
    const double least = relative * relative * values[values.size() - 1];
    const Eigen::Index rank = (values.array() > least).count();
    kept.values = values.tail(rank);
    kept.vectors = eigen.eigenvectors().rightCols(rank);
    return kept;
  }

  template <class Problem>
  [[nodiscard]] solution solve_normal(const Problem& problem) const {
    const normal_equations& normal = problem.normal();
    const auto [lengths, values, vectors] = factorise_normal(normal);
    const Eigen::MatrixXd moment = lengths.cwiseInverse().asDiagonal() * normal.moment();
    const Eigen::MatrixXd projected = vectors.transpose() * moment;
    const Eigen::MatrixXd kept = values.cwiseInverse().asDiagonal() * projected;

    solution found;
    if (values.size() == normal.unknowns())
      found.weights = lengths.cwiseInverse().asDiagonal() * (vectors * kept);
    else
      found.weights = detail::minimum_norm<Eigen::MatrixXd>(lengths.asDiagonal() * vectors, kept);
    found.residual = problem.residual(found.weights);
    found.objective = normal.objective(found.weights);
    found.certificate = stationarity(normal, found.weights);
    return found;
  }

  double threshold_;
};

static_assert(normal_solver<least_squares>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/least_squares.ipp>
#endif
