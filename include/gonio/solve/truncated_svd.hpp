#pragma once
/// Least squares in the directions that explain most of the matrix: regularisation by truncated singular value
/// decomposition. Hansen, BIT 27, 1987; the share of explained variance as Nielsen chooses it, "Statistical
/// surface recovery" (doctoral thesis, DTU 2016, contribution C.V, Eq. 4-7).

#include <gonio/solve/solver.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace gonio {

/// Keeps the fewest singular values of W^(1/2) A whose squares sum to a given share of the sum of all squares, and
/// returns the x of the smallest norm with the least |W^(1/2) (A x - b)| in the subspace of the kept right singular
/// vectors.
///
/// A wide problem (fewer rows than unknowns) is solved through its n x n dual in O(n^2 k), all others through the k x k
/// normal equations. Both give the same x, as long as the share does not end within a group of equal singular values.
/// The squares are computed as eigenvalues, so that a share of 1 means all but the smallest ones that sum to less than
/// epsilon times their number of the total: they are rounding. Use `least_squares` where such directions matter.
///
/// The certificate is computed from the problem and an orthonormal basis V of the subspace, and is the largest of
/// - what A'WA leads out of the subspace, |(I - VV') A'WA V|, relative to the largest eigenvalue of A'WA: V is spanned
///   by singular vectors;
/// - the gradient in the subspace, |V'(A'W(A x - b))|, relative to |A'Wb| + that eigenvalue times |x|;
/// - the part of x outside of the subspace, relative to |x|.
/// Magnitudes are those of the largest entry.
class truncated_svd {
 public:
  /// Throws gonio::error unless the share is above 0 and at most 1.
  explicit truncated_svd(double explained_variance = 0.99);

  [[nodiscard]] double explained_variance() const noexcept { return share_; }

  template <quadratic_problem Problem = least_squares_problem>
  [[nodiscard]] solution solve(const Problem& problem) const {
    if constexpr (requires { problem.rows(); })
      if (problem.equations() < problem.unknowns()) return solve_dual(problem);
    return solve_primal(problem);
  }

  /// How many singular values `solve` keeps.
  template <quadratic_problem Problem = least_squares_problem>
  [[nodiscard]] Eigen::Index kept(const Problem& problem) const {
    if constexpr (requires { problem.rows(); })
      if (problem.equations() < problem.unknowns()) {
        const Eigen::MatrixXd rows = problem.weighted_rows();
        return truncate<Eigen::MatrixXd>(rows * rows.transpose()).values.size();
      }
    return truncate<Eigen::MatrixXd>(problem.normal().gram()).values.size();
  }

 private:
  /// The kept squares of singular values, ascending, and their singular vectors on one side.
  struct spectrum {
    Eigen::VectorXd values;
    Eigen::MatrixXd vectors;
  };

  template <class Matrix>
  [[nodiscard]] spectrum truncate(const Matrix& gram) const {
    if (gram.size() == 0) return {};  // all rows have weight zero
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(gram);
    if (eigen.info() != Eigen::Success) throw error("the singular values of a least-squares problem do not converge");
    const Eigen::VectorXd values = eigen.eigenvalues().cwiseMax(0.0);
    const Eigen::Index all = values.size();
    const double rounding = static_cast<double>(all) * std::numeric_limits<double>::epsilon();
    const double enough = share_ * (1.0 - rounding) * values.sum();
    Eigen::Index kept = 0;
    for (double sum = 0.0; kept < all && sum < enough; ++kept) sum += values[all - 1 - kept];
    return {values.tail(kept), eigen.eigenvectors().rightCols(kept)};
  }

  template <class Problem>
  [[nodiscard]] solution solve_primal(const Problem& problem) const {
    const normal_equations& normal = problem.normal();
    const Eigen::MatrixXd &gram = normal.gram(), &moment = normal.moment();
    const auto [values, vectors] = truncate<Eigen::MatrixXd>(gram);
    Eigen::MatrixXd within = vectors.transpose() * moment;
    for (Eigen::Index i = 0; i < values.size(); ++i) within.row(i) /= values[i];
    const Eigen::MatrixXd x = vectors * within;
    return judged(problem, x, moment, vectors, gram * x, gram * vectors, values);
  }

  template <class Problem>
  [[nodiscard]] solution solve_dual(const Problem& problem) const {
    const Eigen::MatrixXd rows = problem.weighted_rows(), columns = rows.transpose();
    const auto [values, vectors] = truncate<Eigen::MatrixXd>(rows * columns);
    // The kept equations U'A x = U'b, whose minimum-norm solution the factors of A'U give. Division by the eigenvalues
    // instead would lose about half of the digits if they differ much.
    const auto [basis, triangle] = thin_qr<Eigen::MatrixXd>(columns * vectors);
    const Eigen::MatrixXd right = problem.weighted_right_hand_side();
    Eigen::MatrixXd within = vectors.transpose() * right;
    triangle.transpose().template triangularView<Eigen::Lower>().solveInPlace(within);
    const Eigen::MatrixXd x = basis * within;
    const Eigen::MatrixXd projected_image = rows * x, span = rows * basis;
    return judged(problem, x, columns * right, basis, columns * projected_image, columns * span, values);
  }

  template <class Matrix>
  [[nodiscard]] static std::pair<Matrix, Matrix> thin_qr(const Matrix& columns) {
    const Eigen::Index k = columns.rows(), p = columns.cols();
    if (p == 0) return {Matrix(k, 0), Matrix(0, 0)};
    const Eigen::HouseholderQR<Matrix> qr(columns);
    return {qr.householderQ() * Matrix::Identity(k, p), qr.matrixQR().topRows(p)};
  }

  /// With A'WA x and A'WA V at hand.
  template <class Problem>
  [[nodiscard]] static solution judged(const Problem& problem, const Eigen::MatrixXd& x, const Eigen::MatrixXd& moment,
                                       const Eigen::MatrixXd& basis, const Eigen::MatrixXd& projected_image,
                                       const Eigen::MatrixXd& span, const Eigen::VectorXd& values) {
    const double largest = values.size() > 0 ? values[values.size() - 1] : 0.0;
    const double led_out = relative(span - basis * (basis.transpose() * span), largest);
    const Eigen::MatrixXd gradient = basis.transpose() * (projected_image - moment);
    const Eigen::MatrixXd outside = x - basis * (basis.transpose() * x);
    solution found{x, problem.residual(x), Eigen::VectorXd(x.cols()), Eigen::VectorXd(x.cols())};
    for (Eigen::Index column = 0; column < x.cols(); ++column) {
      const double norm = x.col(column).norm();
      found.objective[column] = x.col(column).dot(0.5 * projected_image.col(column) - moment.col(column));
      found.certificate[column] =
          std::max({led_out, relative(gradient.col(column), moment.col(column).norm() + largest * norm),
                    relative(outside.col(column), norm)});
    }
    return found;
  }

  /// The largest magnitude, which is none if nothing is kept.
  [[nodiscard]] static double relative(const Eigen::MatrixXd& violation, double scale);

  double share_;
};

static_assert(normal_solver<truncated_svd>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/truncated_svd.ipp>
#endif
