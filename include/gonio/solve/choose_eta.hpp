#pragma once
/// The penalty of a Tikhonov solver, chosen by how well each observation is predicted from the others.
/// Leave-one-out (PRESS): Allen, Technometrics 16, 1974. Generalised cross-validation: Golub, Heath and Wahba,
/// Technometrics 21, 1979. Both take the rows' errors for independent and fail where they go together, as those of a
/// picture's pixels do if light or camera are off their places (docs/directions.md, docs/eta.md).

#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace gonio {

/// Which penalties are plausible: 0 <= lowest <= highest, which is not 0.
struct eta_range {
  double lowest = 0.0;
  double highest = std::numeric_limits<double>::infinity();
};

/// What a choice of eta minimises. With the residual r = W^(1/2) (A x - b) at eta, the leverages
/// h_i = w_i a_i (A'WA + eta I)^-1 a_i', and all sums over the n rows of positive weight:
enum class eta_criterion {
  generalised_cross_validation,  ///< n sum r_i^2 / (n - sum h_i)^2: leave-one-out with the leverages' mean for each
  leave_one_out,  ///< sum (r_i / (1 - h_i))^2: the weighted squared error of each row predicted from all others
};

namespace detail {

/// Scores of a criterion for many eta from one eigendecomposition: of the n x n dual W^(1/2) A A' W^(1/2) if there are
/// at most as many observations as unknowns, which is exact where residual and 1 - h_i both vanish with eta, else of
/// A'WA.
template <class Problem>
class eta_scores {
 public:
  eta_scores(const Problem& problem, eta_criterion criterion) : problem_(problem), criterion_(criterion) {
    count_ = problem.observations();
    if (count_ < 2)
      throw error("choosing eta by cross-validation needs at least 2 rows of positive weight, not " +
                  std::to_string(count_));
    dual_ = count_ <= problem.unknowns();
    if (dual_)
      decompose_dual();
    else
      decompose(problem.normal().gram(), problem.normal().moment());
    if (!(largest() > 0.0)) throw error("eta cannot be chosen: all rows of positive weight are zero");
  }

  /// The largest eigenvalue of A'WA.
  [[nodiscard]] double largest() const { return values_[values_.size() - 1]; }

  /// The sum over all right-hand sides for each eta.
  [[nodiscard]] Eigen::VectorXd operator()(const Eigen::VectorXd& etas) const {
    if (criterion_ == eta_criterion::generalised_cross_validation) return generalised(etas);
    return dual_ ? leave_one_out_dual(etas) : leave_one_out_primal(etas);
  }

 private:
  void decompose(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& right) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
    if (eigen.info() != Eigen::Success) throw error("the eigenvalues of a least-squares problem do not converge");
    values_ = eigen.eigenvalues().cwiseMax(0.0);
    vectors_ = eigen.eigenvectors();
    coefficients_ = vectors_.transpose() * right;
  }

  void decompose_dual() {
    const Eigen::MatrixXd rows = problem_.weighted_rows(), columns = rows.transpose();
    decompose(rows * columns, problem_.weighted_right_hand_side());
  }

  /// eta / (values + eta): what the penalty leaves of the misfit in each direction, directions x etas.
  [[nodiscard]] Eigen::MatrixXd left_over(const Eigen::VectorXd& etas) const {
    return Eigen::MatrixXd::NullaryExpr(
        values_.size(), etas.size(), [&](Eigen::Index i, Eigen::Index e) { return etas[e] / (values_[i] + etas[e]); });
  }

  [[nodiscard]] Eigen::VectorXd generalised(const Eigen::VectorXd& etas) const {
    const auto n = static_cast<double>(count_), others = static_cast<double>(count_ - values_.size());
    const Eigen::VectorXd freedom = left_over(etas).colwise().sum().transpose();
    const Eigen::VectorXd squares = dual_ ? squared_residuals_dual(etas) : squared_residuals_primal(etas);
    return n * squares.array() / (others + freedom.array()).square();
  }

  [[nodiscard]] Eigen::VectorXd squared_residuals_dual(const Eigen::VectorXd& etas) const {
    const Eigen::VectorXd energy = coefficients_.rowwise().squaredNorm();
    return left_over(etas).cwiseAbs2().transpose() * energy;
  }

  /// From the rows at the smallest eta, and from there on by sums of terms that are not negative, so that nothing
  /// cancels where the residual is small: with f = eta / (lambda + eta), |r|^2 grows by z^2 / lambda times the growth
  /// of f^2 in each direction.
  [[nodiscard]] Eigen::VectorXd squared_residuals_primal(const Eigen::VectorXd& etas) const {
    const double first = etas.minCoeff();
    const Eigen::VectorXd energy = coefficients_.rowwise().squaredNorm();
    Eigen::MatrixXd shrunk = coefficients_;
    for (Eigen::Index i = 0; i < values_.size(); ++i) shrunk.row(i) /= values_[i] + first;
    const Eigen::MatrixXd x = vectors_ * shrunk;
    Eigen::VectorXd squares = Eigen::VectorXd::Constant(etas.size(), problem_.residual(x).squaredNorm());
    for (Eigen::Index e = 0; e < etas.size(); ++e)
      for (Eigen::Index i = 0; i < values_.size(); ++i) {
        const double eta = etas[e], value = values_[i], both = (value + eta) * (value + first);
        squares[e] += energy[i] / both * (eta - first) * (2.0 * eta * first + value * (eta + first)) / both;
      }
    return squares;
  }

  /// r = U f U'b and 1 - h = U^2 f in the eigenvectors U of the dual.
  [[nodiscard]] Eigen::VectorXd leave_one_out_dual(const Eigen::VectorXd& etas) const {
    const Eigen::MatrixXd factors = left_over(etas), squares = vectors_.cwiseAbs2(), remaining = squares * factors;
    Eigen::VectorXd scores = Eigen::VectorXd::Zero(etas.size());
    for (Eigen::Index column = 0; column < coefficients_.cols(); ++column) {
      const Eigen::MatrixXd scaled = coefficients_.col(column).asDiagonal() * factors;
      const Eigen::MatrixXd residuals = vectors_ * scaled;
      scores += residuals.cwiseQuotient(remaining).colwise().squaredNorm().transpose();
    }
    return scores;
  }

  /// One pass over the rows for all eta: with u = V'a of a row a, h = sum of u_j^2 / (lambda_j + eta).
  [[nodiscard]] Eigen::VectorXd leave_one_out_primal(const Eigen::VectorXd& etas) const {
    const Eigen::MatrixXd factors = left_over(etas).array().rowwise() / etas.transpose().array();
    std::vector<Eigen::MatrixXd> scaled;
    for (Eigen::Index column = 0; column < coefficients_.cols(); ++column)
      scaled.emplace_back(coefficients_.col(column).asDiagonal() * factors);
    // No leverage exceeds the largest eigenvalue of the hat matrix, but for rounding.
    const Eigen::VectorXd least = etas.array() / (largest() + etas.array());
    Eigen::VectorXd scores = Eigen::VectorXd::Zero(etas.size());
    problem_.for_each_row_block([&](block range, const row_matrix& part) {
      const auto begin = static_cast<Eigen::Index>(range.begin);
      const Eigen::VectorXd root = problem_.weights().segment(begin, part.rows()).cwiseSqrt();
      const Eigen::MatrixXd rows = root.asDiagonal() * part, projected = rows * vectors_;
      const Eigen::MatrixXd squares = projected.cwiseAbs2(), leverages = squares * factors;
      for (std::size_t column = 0; column < scaled.size(); ++column) {
        const Eigen::VectorXd right = root.cwiseProduct(
            problem_.right_hand_side().col(static_cast<Eigen::Index>(column)).segment(begin, part.rows()));
        const Eigen::MatrixXd fitted = projected * scaled[column];
        for (Eigen::Index e = 0; e < etas.size(); ++e)
          scores[e] +=
              ((right - fitted.col(e)).array() / (1.0 - leverages.col(e).array()).max(least[e])).square().sum();
      }
    });
    return scores;
  }

  const Problem& problem_;
  eta_criterion criterion_;
  Eigen::Index count_ = 0;  // observations
  bool dual_ = false;
  Eigen::VectorXd values_;        // ascending
  Eigen::MatrixXd vectors_;       // of the dual (U) or of A'WA (V)
  Eigen::MatrixXd coefficients_;  // U'W^(1/2) b or V'A'Wb
};

/// `count` numbers from `first` to `last` with equal ratios.
[[nodiscard]] Eigen::VectorXd geometric(double first, double last, Eigen::Index count);

/// Where the least score is; of those that are equal but for rounding, the last.
[[nodiscard]] Eigen::Index last_least(const Eigen::VectorXd& scores);

/// Where a function of many eta has its least value: of eight a decade from first to last, then of 31 between the
/// neighbours of the best.
template <class Scores>
[[nodiscard]] double eta_of_least(const Scores& scores, double first, double last) {
  const auto steps = std::max<Eigen::Index>(std::llround(8.0 * std::log10(last / first)), 1);
  const Eigen::VectorXd coarse = geometric(first, last, steps + 1);
  const Eigen::Index best = last_least(scores(coarse));
  const Eigen::VectorXd fine =
      geometric(coarse[std::max<Eigen::Index>(best - 1, 0)], coarse[std::min<Eigen::Index>(best + 1, steps)], 31);
  return fine[last_least(scores(fine))];
}

void require_etas(const eta_range& range);

}  // namespace detail

/// The criterion at each eta, summed over all right-hand sides, in the squared units of W^(1/2) b. Throws gonio::error
/// unless every eta is positive and finite, and as `choose_eta` does, whose complexity it has.
template <class Problem = least_squares_problem>
[[nodiscard]] Eigen::VectorXd cross_validate(const Problem& problem, eta_criterion criterion,
                                             const Eigen::VectorXd& etas) {
  if (etas.size() == 0) throw error("cross-validation needs at least one eta");
  for (const double eta : etas)
    if (!(eta > 0.0 && std::isfinite(eta)))
      throw error("cross-validation needs values of eta that are positive and finite, not " + std::to_string(eta));
  return detail::eta_scores<Problem>(problem, criterion)(etas);
}

/// The eta of `tikhonov` that minimises a criterion, one for all right-hand sides together.
///
/// Eight candidates a decade, from 1e-10 of the largest eigenvalue of A'WA, below which rounding decides, to a hundred
/// times that eigenvalue; then 31 between the neighbours of the best. Of equal scores the largest eta wins: where
/// nothing speaks for a smaller one, x stays near 0. A choice at the lower end means that no penalty is needed, one at
/// the upper end that the rows do not predict each other. With few rows that happens by chance: whoever knows more
/// says which etas are plausible, and the choice is among these (`plausible_etas` asks a prior).
///
/// Only rows of positive weight are observations. Throws gonio::error if there are less than two, because what is
/// predicted from no observation does not depend on eta, unless the range has an upper end, which it is then; if they
/// are all zero; if one is not finite; and for an impossible range.
///
/// n x n dual: O(n^2 k + n^3). Tall: O(n k^2 + k^3), and leave-one-out reads the rows twice for O(n k (k + E r)) with
/// the number of candidates E.
template <class Problem = least_squares_problem>
[[nodiscard]] double choose_eta(const Problem& problem, eta_criterion criterion, const eta_range& plausible = {}) {
  detail::require_etas(plausible);
  if (problem.observations() < 2 && std::isfinite(plausible.highest)) return plausible.highest;
  const detail::eta_scores<Problem> scores(problem, criterion);
  const auto bounded = [&](double eta) { return std::clamp(eta, plausible.lowest, plausible.highest); };
  return bounded(detail::eta_of_least(scores, bounded(1e-10 * scores.largest()), bounded(1e2 * scores.largest())));
}

/// `tikhonov` with the eta that `choose_eta` chooses for each problem. It needs the rows: normal equations alone do not
/// tell observations apart. The penalty in the objective and in the certificate is that of the chosen eta.
class automatic_tikhonov {
 public:
  /// Throws gonio::error for an impossible range.
  explicit automatic_tikhonov(eta_criterion criterion = eta_criterion::generalised_cross_validation,
                              const eta_range& plausible = {})
      : criterion_(criterion), plausible_(plausible) {
    detail::require_etas(plausible);
  }

  [[nodiscard]] eta_criterion criterion() const noexcept { return criterion_; }
  [[nodiscard]] const eta_range& plausible() const noexcept { return plausible_; }

  /// Throws gonio::error as `choose_eta` does.
  template <quadratic_problem Problem = least_squares_problem>
  requires requires(const Problem& problem) { problem.rows(); }
  [[nodiscard]] solution solve(const Problem& problem) const {
    return tikhonov(choose_eta(problem, criterion_, plausible_)).solve(problem);
  }

 private:
  eta_criterion criterion_;
  eta_range plausible_;
};

static_assert(solver<automatic_tikhonov> && !normal_solver<automatic_tikhonov>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/choose_eta.ipp>
#endif
