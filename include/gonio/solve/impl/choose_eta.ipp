#pragma once
/// Bodies of solve/choose_eta.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/choose_eta.hpp>
#include <gonio/solve/dense.hpp>
#include <gonio/solve/symmetric_eigen.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::detail {

/// Computes a criterion for many etas from one eigendecomposition: of the n x n dual W^(1/2) A A' W^(1/2) if there are
/// no more observations than unknowns, else of A'WA. The dual is exact even if the residual and 1 - h_i both vanish
/// with eta.
class eta_scores {
 public:
  eta_scores(const least_squares_problem& problem, eta_criterion criterion) : problem_(problem), criterion_(criterion) {
    count_ = problem.observations();
    if (count_ < 2) refuse({"choosing eta by cross-validation needs at least 2 rows of positive weight, not ", count_});
    dual_ = count_ <= problem.unknowns();
    if (dual_)
      decompose_dual();
    else
      decompose(problem.normal().gram(), problem.normal().rhs());
    if (!(largest() > 0.0))
      refuse("eta cannot be chosen, because all rows of positive weight are 0: give a number (--eta)");
  }

  /// Returns the largest eigenvalue of A'WA.
  [[nodiscard]] double largest() const { return values_[values_.size() - 1]; }

  /// Returns the criterion at each eta, summed over all right-hand sides.
  [[nodiscard]] Eigen::VectorXd operator()(const Eigen::VectorXd& etas) const {
    if (criterion_ == eta_criterion::generalised_cross_validation) return generalised(etas);
    return dual_ ? leave_one_out_dual(etas) : leave_one_out_primal(etas);
  }

 private:
  void decompose(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& right) {
    symmetric_eigen eigen = decompose_symmetric(gram, "a least-squares problem");
    values_ = eigen.values.cwiseMax(0.0);
    vectors_ = std::move(eigen.vectors);
    coefficients_ = product(vectors_.transpose(), right);
  }

  void decompose_dual() {
    decompose(product_with_transpose(problem_.weighted_rows()), problem_.weighted_right_hand_side());
  }

  /// Returns eta / (value + eta) for each eigenvalue: the share of the misfit in the direction of its eigenvector that
  /// the penalty leaves. Eigenvalues x etas.
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
    const Eigen::VectorXd squared_norms = coefficients_.rowwise().squaredNorm();
    const Eigen::MatrixXd factors = left_over(etas);
    Eigen::VectorXd squares(etas.size());
    for (Eigen::Index e = 0; e < etas.size(); ++e) squares[e] = factors.col(e).cwiseAbs2().dot(squared_norms);
    return squares;
  }

  /// Computes |r|^2 from the rows at the smallest eta, and adds non-negative terms for each larger eta: nothing cancels
  /// if the residual is small. In the direction of an eigenvector with eigenvalue lambda and coefficient z, |r|^2 grows
  /// by z^2 / lambda times the growth of f^2, where f = eta / (lambda + eta).
  [[nodiscard]] Eigen::VectorXd squared_residuals_primal(const Eigen::VectorXd& etas) const {
    const double first = etas.minCoeff();
    const Eigen::VectorXd squared_norms = coefficients_.rowwise().squaredNorm();
    Eigen::MatrixXd shrunk = coefficients_;
    for (Eigen::Index i = 0; i < values_.size(); ++i) shrunk.row(i) /= values_[i] + first;
    const Eigen::MatrixXd x = product(vectors_, shrunk);
    Eigen::VectorXd squares = Eigen::VectorXd::Constant(etas.size(), problem_.residual(x).squaredNorm());
    for (Eigen::Index e = 0; e < etas.size(); ++e)
      for (Eigen::Index i = 0; i < values_.size(); ++i) {
        const double eta = etas[e], value = values_[i], both = (value + eta) * (value + first);
        squares[e] += squared_norms[i] / both * (eta - first) * (2.0 * eta * first + value * (eta + first)) / both;
      }
    return squares;
  }

  /// Computes the criterion from r = U f U'b and 1 - h = U^2 f, where U are the eigenvectors of the dual.
  [[nodiscard]] Eigen::VectorXd leave_one_out_dual(const Eigen::VectorXd& etas) const {
    const Eigen::MatrixXd factors = left_over(etas), remaining = product(vectors_.cwiseAbs2(), factors);
    Eigen::VectorXd scores = Eigen::VectorXd::Zero(etas.size());
    for (Eigen::Index column = 0; column < coefficients_.cols(); ++column) {
      const Eigen::MatrixXd residuals = product(vectors_, scaled(factors, column));
      scores += residuals.cwiseQuotient(remaining).colwise().squaredNorm().transpose();
    }
    return scores;
  }

  /// Reads the rows once for all etas. The leverage of a row a is h = sum of u_j^2 / (lambda_j + eta) with u = V'a.
  [[nodiscard]] Eigen::VectorXd leave_one_out_primal(const Eigen::VectorXd& etas) const {
    const Eigen::MatrixXd factors = left_over(etas).array().rowwise() / etas.transpose().array();
    std::vector<Eigen::MatrixXd> of_each;
    for (Eigen::Index column = 0; column < coefficients_.cols(); ++column) of_each.push_back(scaled(factors, column));
    // Bound 1 - h from below: except by rounding, no leverage exceeds the largest eigenvalue of the hat matrix.
    const Eigen::VectorXd least = etas.array() / (largest() + etas.array());
    Eigen::VectorXd scores = Eigen::VectorXd::Zero(etas.size());
    problem_.for_each_row_block([&](block range, const row_matrix& part) {
      const Eigen::Index begin = range.begin;
      const Eigen::VectorXd root = problem_.weights().segment(begin, part.rows()).cwiseSqrt();
      Eigen::MatrixXd projected = product(part, vectors_);
      for (Eigen::Index j = 0; j < projected.cols(); ++j) projected.col(j).array() *= root.array();
      const Eigen::MatrixXd leverages = product(projected.cwiseAbs2(), factors);
      for (Eigen::Index column = 0; column < std::ssize(of_each); ++column) {
        const Eigen::VectorXd right =
            root.cwiseProduct(problem_.right_hand_side().col(column).segment(begin, part.rows()));
        const Eigen::MatrixXd fitted = product(projected, of_each[column]);
        for (Eigen::Index e = 0; e < etas.size(); ++e)
          scores[e] +=
              ((right - fitted.col(e)).array() / (1.0 - leverages.col(e).array()).max(least[e])).square().sum();
      }
    });
    return scores;
  }

  /// Returns U'W^(1/2) b or V'A'Wb of one right-hand side, times the factors of each eta: eigenvalues x etas.
  [[nodiscard]] Eigen::MatrixXd scaled(Eigen::MatrixXd factors, Eigen::Index column) const {
    for (Eigen::Index e = 0; e < factors.cols(); ++e) factors.col(e).array() *= coefficients_.col(column).array();
    return factors;
  }

  const least_squares_problem& problem_;
  eta_criterion criterion_;
  Eigen::Index count_ = 0;  // observations
  bool dual_ = false;
  Eigen::VectorXd values_;        // ascending
  Eigen::MatrixXd vectors_;       // eigenvectors of the dual (U) or of A'WA (V)
  Eigen::MatrixXd coefficients_;  // U'W^(1/2) b or V'A'Wb
};

GONIO_INLINE Eigen::Index last_least(const Eigen::VectorXd& scores) {
  const double bound = scores.minCoeff() * (1.0 + 1e-10);
  Eigen::Index at = scores.size() - 1;
  while (at > 0 && !(scores[at] <= bound)) --at;
  return at;
}

GONIO_INLINE void require_etas(const eta_range& range) {
  if (!(range.lowest >= 0.0 && range.lowest <= range.highest && range.highest > 0.0 && std::isfinite(range.lowest)))
    refuse(
        {"a range of eta must go from at least 0 to a larger number, not from ", range.lowest, " to ", range.highest});
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE Eigen::VectorXd geometric_sequence(double first, double last, Eigen::Index count) {
  const double step = std::log(last / first) / static_cast<double>(count - 1);
  Eigen::VectorXd numbers(count);
  for (Eigen::Index i = 0; i < count; ++i) numbers[i] = first * std::exp(step * static_cast<double>(i));
  return numbers;
}

GONIO_INLINE Eigen::VectorXd cross_validate(const least_squares_problem& problem, eta_criterion criterion,
                                            const Eigen::VectorXd& etas) {
  if (etas.size() == 0) refuse("cross-validation needs at least one eta");
  for (const double eta : etas)
    if (!(eta > 0.0 && std::isfinite(eta)))
      refuse({"cross-validation needs positive and finite values of eta, not ", eta});
  return detail::eta_scores(problem, criterion)(etas);
}

GONIO_INLINE double choose_eta(const least_squares_problem& problem, eta_criterion criterion,
                               const eta_range& plausible) {
  return choose_eta({&problem, 1}, criterion, plausible);
}

GONIO_INLINE double choose_eta(std::span<const least_squares_problem> problems, eta_criterion criterion,
                               const eta_range& plausible) {
  detail::require_etas(plausible);
  if (problems.empty()) refuse("choosing eta needs at least one problem");
  const auto is_telling = [](const least_squares_problem& problem) { return problem.observations() >= 2; };
  const bool any_tells = std::ranges::any_of(problems, is_telling);
  if (!any_tells && std::isfinite(plausible.highest)) return plausible.highest;
  detail::summed_scores<detail::eta_scores> scores;
  for (const least_squares_problem& problem : problems)
    if (is_telling(problem) || !any_tells) scores.parts.emplace_back(problem, criterion);
  const double largest = scores.largest();
  const auto bounded = [&](double eta) { return std::clamp(eta, plausible.lowest, plausible.highest); };
  return bounded(detail::eta_of_least(scores, bounded(1e-10 * largest), bounded(1e2 * largest)));
}

}  // namespace gonio
