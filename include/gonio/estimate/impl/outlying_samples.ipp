#pragma once
/// Bodies of estimate/outlying_samples.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/outlying_samples.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/product.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace gonio {

namespace detail {

/// Each of the samples from all others, given the inverse of their covariance.
[[nodiscard]] GONIO_INLINE left_out_predictions predict_by_inverse(const Eigen::MatrixXd& inverse,
                                                                   const Eigen::MatrixXd& values) {
  const Eigen::MatrixXd dual = product(inverse, values);
  left_out_predictions found{values, values, Eigen::VectorXd(inverse.rows())};
  for (Eigen::Index i = 0; i < inverse.rows(); ++i) {
    found.mean.row(i) -= dual.row(i) / inverse(i, i);
    found.deviation[i] = std::sqrt(1.0 / inverse(i, i));
  }
  return found;
}

[[nodiscard]] GONIO_INLINE Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& covariance) {
  const cholesky factors(covariance);
  if (!factors.positive_definite()) refuse("the covariance of the samples is not positive definite");
  return factors.solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
}

}  // namespace detail

GONIO_INLINE left_out_predictions predict_left_out(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& values) {
  return detail::predict_by_inverse(detail::inverse_of(covariance), values);
}

namespace detail {

/// Rows and columns of a matrix, or rows alone.
[[nodiscard]] inline Eigen::MatrixXd part_of(const Eigen::MatrixXd& whole, const std::vector<Eigen::Index>& rows,
                                             const std::vector<Eigen::Index>& columns) {
  Eigen::MatrixXd part(std::ssize(rows), std::ssize(columns));
  for (Eigen::Index j = 0; j < part.cols(); ++j)
    for (Eigen::Index i = 0; i < part.rows(); ++i) part(i, j) = whole(rows[i], columns[j]);
  return part;
}

[[nodiscard]] inline std::vector<Eigen::Index> numbers_up_to(Eigen::Index count) {
  std::vector<Eigen::Index> all(count);
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  return all;
}

/// The disagreement of the bulk: the median over what it is expected to be, at least 1. Of three independent channels
/// the mean square of three standard normal numbers has the median 0.789.
[[nodiscard]] inline double bulk_disagreement(const Eigen::VectorXd& disagreement) {
  constexpr double expected_median = 0.789;
  std::vector<double> all(disagreement.data(), disagreement.data() + disagreement.size());
  return std::max(median(all) / expected_median, 1.0);
}

GONIO_INLINE std::vector<rejection_step> reject(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& values,
                                                const rejection_rule& rule) {
  if (!(rule.threshold > 0.0) || !(rule.largest_share >= 0.0 && rule.largest_share < 1.0))
    refuse({"the rule by which samples are left out needs a positive threshold and a share from 0 up to 1, not ",
            rule.threshold, " and ", rule.largest_share});
  std::vector<Eigen::Index> kept = numbers_up_to(covariance.rows());
  const std::vector<Eigen::Index> channels = numbers_up_to(values.cols());
  const auto most =
      std::max<Eigen::Index>(static_cast<Eigen::Index>(rule.largest_share * static_cast<double>(kept.size())), 1);
  const double threshold = rule.threshold * std::sqrt(std::max(static_cast<double>(kept.size()) / 20.0, 1.0));
  Eigen::MatrixXd inverse = inverse_of(covariance);
  std::vector<rejection_step> steps;
  while (std::ssize(steps) < most && kept.size() > 2) {
    const Eigen::VectorXd disagreement = predict_by_inverse(inverse, part_of(values, kept, channels)).disagreement();
    Eigen::Index worst = 0;
    const double largest = disagreement.maxCoeff(&worst) / bulk_disagreement(disagreement);
    if (!(largest > threshold)) break;
    steps.push_back({kept[worst], largest});
    // The inverse of the covariance without a row and column is the Schur complement of the whole inverse.
    std::vector<Eigen::Index> others = numbers_up_to(inverse.rows());
    others.erase(others.begin() + worst);
    const Eigen::VectorXd scaled = inverse.col(worst) / inverse(worst, worst);
    for (Eigen::Index j = 0; j < inverse.cols(); ++j)
      if (j != worst) inverse.col(j) -= inverse(worst, j) * scaled;
    inverse = part_of(inverse, others, others);
    kept.erase(kept.begin() + worst);
  }
  return steps;
}

GONIO_INLINE left_out_predictions predict_from_others(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& values,
                                                      const std::vector<Eigen::Index>& left_out) {
  const std::vector<Eigen::Index> out(left_out.begin(), left_out.end()), channels = numbers_up_to(values.cols());
  std::vector<Eigen::Index> kept = numbers_up_to(covariance.rows());
  std::erase_if(kept, [&](Eigen::Index i) { return std::ranges::find(out, i) != out.end(); });
  const Eigen::MatrixXd between = part_of(covariance, kept, out);
  const cholesky factors(part_of(covariance, kept, kept));
  if (!factors.positive_definite()) refuse("the covariance of the samples is not positive definite");
  const Eigen::MatrixXd half = factors.solve_lower(between);
  left_out_predictions found{part_of(values, out, channels),
                             product(half.transpose(), factors.solve_lower(part_of(values, kept, channels))),
                             Eigen::VectorXd(std::ssize(out))};
  for (Eigen::Index i = 0; i < std::ssize(out); ++i) {
    const Eigen::Index number = out[i];
    found.deviation[i] = std::sqrt(std::max(covariance(number, number) - half.col(i).squaredNorm(), 0.0));
  }
  return found;
}

}  // namespace detail

}  // namespace gonio
