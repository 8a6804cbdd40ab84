#pragma once
/// Bodies of estimate/sample_process.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/probability.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/estimate/sample_process.hpp>
#include <gonio/solve/product.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

[[nodiscard]] GONIO_INLINE Eigen::MatrixXd part_of(const Eigen::MatrixXd& whole, std::span<const Eigen::Index> rows,
                                                   std::span<const Eigen::Index> columns) {
  Eigen::MatrixXd part(std::ssize(rows), std::ssize(columns));
  for (Eigen::Index j = 0; j < part.cols(); ++j)
    for (Eigen::Index i = 0; i < part.rows(); ++i) part(i, j) = whole(rows[i], columns[j]);
  return part;
}

[[nodiscard]] GONIO_INLINE Eigen::MatrixXd rows_of_matrix(const Eigen::MatrixXd& whole,
                                                          std::span<const Eigen::Index> rows) {
  Eigen::MatrixXd part(std::ssize(rows), whole.cols());
  for (Eigen::Index j = 0; j < part.cols(); ++j)
    for (Eigen::Index i = 0; i < part.rows(); ++i) part(i, j) = whole(rows[i], j);
  return part;
}

[[nodiscard]] GONIO_INLINE Eigen::MatrixXd divided(Eigen::MatrixXd numbers, double by) {
  for (Eigen::Index i = 0; i < numbers.size(); ++i) numbers.data()[i] /= by;
  return numbers;
}

[[nodiscard]] GONIO_INLINE Eigen::MatrixXd difference(Eigen::MatrixXd a, const Eigen::MatrixXd& b) {
  add_scaled(-1.0, b, a);
  return a;
}

[[nodiscard]] GONIO_INLINE double squared_norm(const matrix_view& a) {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < a.cols(); ++j)
    sum += dot(a.data() + j * a.outerStride(), a.data() + j * a.outerStride(), a.rows());
  return sum;
}

[[nodiscard]] GONIO_INLINE cholesky factors_of(const Eigen::MatrixXd& covariance) {
  cholesky factors(covariance);
  if (!factors.positive_definite()) refuse("the covariance of the samples is not positive definite");
  return factors;
}

}  // namespace detail

GONIO_INLINE Eigen::VectorXd sample_predictions::disagreement() const {
  Eigen::VectorXd found = Eigen::VectorXd::Zero(mapped.rows());
  for (Eigen::Index c = 0; c < mapped.cols(); ++c)
    for (Eigen::Index i = 0; i < found.size(); ++i) {
      const double off = (mapped(i, c) - mean(i, c)) / deviation[i];
      found[i] += off * off / static_cast<double>(mapped.cols());
    }
  return found;
}

GONIO_INLINE double grazing_share(const half_difference& angles, double reach) noexcept {
  const cosine_pair cosine = cosines(angles);
  const double above = std::asin(std::clamp(std::min(cosine.i, cosine.o), 0.0, 1.0));
  return std::exp(-above / reach);
}

GONIO_INLINE double error_variance_at(const discrepancy_model& model, const half_difference& angles) noexcept {
  if (model.grazing_variance == 0.0) return model.error_variance;
  return model.error_variance + model.grazing_variance * grazing_share(angles, radians(2.5));
}

GONIO_INLINE Eigen::VectorXd crowding_variances(const discrepancy_model& model, std::span<const location> locations) {
  constexpr double reach = radians(1.5);
  // Twice the number of samples that would be within reach if theta_d was uniform.
  const double usual = 2.0 * (4.0 * reach / std::numbers::pi) * static_cast<double>(locations.size());
  std::vector<double> sorted;
  for (const location& at : locations) sorted.push_back(at.angles.theta_d);
  std::ranges::sort(sorted);
  Eigen::VectorXd variances(std::ssize(locations));
  for (Eigen::Index i = 0; i < variances.size(); ++i) {
    const half_difference& angles = locations[i].angles;
    const auto together = std::ranges::upper_bound(sorted, angles.theta_d + reach) -
                          std::ranges::lower_bound(sorted, angles.theta_d - reach);
    const double crowd = static_cast<double>(together) - usual;
    variances[i] = error_variance_at(model, angles) * std::max(crowd / model.effective_samples - 1.0, 0.0);
  }
  return variances;
}

namespace detail {

/// Returns the factor by which the variances of doubts grow towards grazing theta_d.
[[nodiscard]] inline double fresnel_factor(const doubt_model& doubt, const half_difference& angles) noexcept {
  return 1.0 + doubt.fresnel_weight * fresnel_rise(angles.theta_d);
}

/// Returns how much larger the variance of a sample's error is with doubts than without.
[[nodiscard]] inline double doubted_error_variance(const discrepancy_model& model,
                                                   const half_difference& angles) noexcept {
  return model.error_variance * (fresnel_factor(model.doubt, angles) - 1.0);
}

/// Adds the covariance of the doubts between some angles (rows) and others (columns).
GONIO_INLINE void add_doubts(const doubt_model& doubt, std::span<const half_difference> some,
                             std::span<const half_difference> others, Eigen::MatrixXd& sum) {
  const Eigen::MatrixXd correlation = discrepancy_covariance(some, others, doubt.lengths);
  std::vector<double> deviations;
  for (const half_difference& each : some)
    deviations.push_back(std::sqrt(doubt.variance * fresnel_factor(doubt, each)));
  for (Eigen::Index j = 0; j < sum.cols(); ++j) {
    const double deviation = std::sqrt(doubt.variance * fresnel_factor(doubt, others[j]));
    for (Eigen::Index i = 0; i < sum.rows(); ++i) sum(i, j) += deviations[i] * deviation * correlation(i, j);
  }
}

}  // namespace detail

GONIO_INLINE Eigen::MatrixXd expected_covariance::among(const located_rows& all) const {
  Eigen::MatrixXd sum = detail::divided(product_with_transpose(all.rows), observations);
  if (model.variance != 0.0) add_scaled(model.variance, discrepancy_covariance(all.angles, model.lengths), sum);
  if (doubts) detail::add_doubts(model.doubt, all.angles, all.angles, sum);
  return sum;
}

GONIO_INLINE Eigen::MatrixXd expected_covariance::between(const located_rows& some, const located_rows& others) const {
  Eigen::MatrixXd sum = detail::divided(product(some.rows, others.rows.transpose()), observations);
  if (model.variance != 0.0)
    add_scaled(model.variance, discrepancy_covariance(some.angles, others.angles, model.lengths), sum);
  if (doubts) detail::add_doubts(model.doubt, some.angles, others.angles, sum);
  return sum;
}

GONIO_INLINE sample_process::stored::stored(expected_covariance model, located_rows rows, Eigen::MatrixXd weights,
                                            Eigen::VectorXd errors, Eigen::MatrixXd without_errors)
    : expected(std::move(model)),
      at(std::move(rows)),
      sample_weights(std::move(weights)),
      error_variances(std::move(errors)),
      covariance(std::move(without_errors)) {
  const Eigen::VectorXd on_diagonal = errors_of(*this);
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) covariance(i, i) += on_diagonal[i];
}

GONIO_INLINE sample_process::sample_process(const expected_covariance& expected, located_rows at,
                                            const located_samples& mapped, const Eigen::VectorXd& error_variances)
    : values_(mapped.values) {
  Eigen::MatrixXd among = expected.among(at);
  shared_ = std::make_shared<const stored>(expected, std::move(at), mapped.weights, error_variances, std::move(among));
}

GONIO_INLINE sample_process::sample_process(std::shared_ptr<const stored> shared, Eigen::MatrixXd values)
    : shared_(std::move(shared)), values_(std::move(values)) {}

GONIO_INLINE Eigen::VectorXd sample_process::errors_of(const stored& parts, std::optional<Eigen::Index> column) {
  const Eigen::MatrixXd& weights = parts.sample_weights;
  const auto columns = static_cast<double>(weights.cols());
  Eigen::VectorXd errors(weights.rows());
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    double sum = 0.0;
    for (Eigen::Index c = 0; c < weights.cols(); ++c) sum += weights(i, c);
    errors[i] = parts.error_variances[i] / (column ? weights(i, *column) : sum / columns);
  }
  return errors;
}

GONIO_INLINE const cholesky& sample_process::factors() const {
  std::call_once(shared_->factorised, [&] { shared_->factors = detail::factors_of(shared_->covariance); });
  return *shared_->factors;
}

GONIO_INLINE const Eigen::MatrixXd& sample_process::inverse() const {
  std::call_once(shared_->inverted, [&] { shared_->inverse = factors().inverse(); });
  return shared_->inverse;
}

GONIO_INLINE sample_process sample_process::with_values(Eigen::MatrixXd values) const {
  if (values.rows() != size())
    refuse({"a process of ", size(), " samples needs a value for each, not ", values.rows()});
  return {shared_, std::move(values)};
}

GONIO_INLINE sample_process sample_process::with_doubts() const {
  expected_covariance doubting = expected();
  doubting.doubts = true;
  Eigen::MatrixXd among = doubting.among(at());
  add_scaled(doubting.model.doubt.shared_error_variance, discrepancy_covariance(at().angles, doubting.model.lengths),
             among);
  Eigen::VectorXd errors = shared_->error_variances;
  for (Eigen::Index i = 0; i < size(); ++i) errors[i] += detail::doubted_error_variance(doubting.model, at().angles[i]);
  return {std::make_shared<const stored>(doubting, at(), shared_->sample_weights, std::move(errors), std::move(among)),
          values_};
}

GONIO_INLINE sample_process sample_process::subset(std::span<const Eigen::Index> positions,
                                                   const Eigen::VectorXd& inlier_weights) const {
  located_rows some{detail::rows_of_matrix(at().rows, positions), {}};
  for (const Eigen::Index i : positions) some.angles.push_back(at().angles[i]);
  Eigen::MatrixXd without_errors = detail::part_of(covariance(), positions, positions);
  const Eigen::VectorXd all_errors = errors_of(*shared_);
  Eigen::MatrixXd weights = detail::rows_of_matrix(shared_->sample_weights, positions);
  Eigen::VectorXd errors(some.size());
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    without_errors(i, i) -= all_errors[positions[i]];
    errors[i] = shared_->error_variances[positions[i]];
    for (Eigen::Index c = 0; c < weights.cols() && inlier_weights.size() > 0; ++c)
      weights(i, c) *= inlier_weights[positions[i]];
  }
  return {std::make_shared<const stored>(expected(), std::move(some), std::move(weights), std::move(errors),
                                         std::move(without_errors)),
          detail::rows_of_matrix(values_, positions)};
}

GONIO_INLINE solution sample_process::fit() const {
  const Eigen::Index n = size(), k = at().rows.cols();
  const bool apart = shared_->sample_weights.cols() > 1;
  const Eigen::Index together = apart ? 1 : channels();
  solution found{Eigen::MatrixXd(k + n, channels()),
                 {Eigen::VectorXd(channels()), Eigen::VectorXd(channels()), Eigen::VectorXd(channels())}};
  const Eigen::VectorXd mean_errors = errors_of(*shared_);
  for (Eigen::Index first = 0; first < channels(); first += together) {
    // Solve K a = y for the dual a of these channels, and refine it once.
    const Eigen::VectorXd errors = apart ? errors_of(*shared_, first) : mean_errors;
    Eigen::MatrixXd own_covariance;
    std::optional<cholesky> own_factors;
    if (apart) {
      own_covariance = covariance();
      for (Eigen::Index i = 0; i < n; ++i) own_covariance(i, i) += errors[i] - mean_errors[i];
      own_factors = detail::factors_of(own_covariance);
    }
    const Eigen::MatrixXd& among = apart ? own_covariance : covariance();
    const cholesky& by = apart ? *own_factors : factors();
    const Eigen::MatrixXd y = values_.middleCols(first, together);
    Eigen::MatrixXd dual = by.solve(y);
    add_scaled(1.0, by.solve(detail::difference(y, product(among, dual))), dual);
    const Eigen::MatrixXd off = detail::difference(y, product(among, dual));

    const Eigen::MatrixXd components = detail::divided(product(at().rows.transpose(), dual), expected().observations);
    for (Eigen::Index c = 0; c < together; ++c) {
      std::copy_n(&components(0, c), k, &found.weights(0, first + c));
      for (Eigen::Index i = 0; i < n; ++i) found.weights(k + i, first + c) = expected().model.variance * dual(i, c);
      // Report the residual with row weights error_variance / E and eta = m error_variance.
      const double unit = expected().model.error_variance;
      double squares = 0.0, gain = 0.0, largest = 0.0, worst = 0.0;
      for (Eigen::Index i = 0; i < n; ++i) {
        squares += errors[i] * dual(i, c) * dual(i, c);
        gain += y(i, c) * (dual(i, c) - y(i, c) / errors[i]);
        largest = std::max(largest, std::abs(y(i, c)));
        // Treat NaN as infinite: std::max would ignore it.
        const double misfit = std::abs(off(i, c));
        worst = std::isfinite(misfit) ? std::max(worst, misfit) : std::numeric_limits<double>::infinity();
      }
      found.report.residual[first + c] = std::sqrt(unit * squares);
      found.report.objective[first + c] = 0.5 * unit * gain;
      found.report.kkt_residual[first + c] = worst / (largest > 0.0 ? largest : 1.0);
    }
  }
  return detail::require_certified(std::move(found), "the sample process");
}

GONIO_INLINE sample_predictions sample_process::predicted_without() const {
  const Eigen::MatrixXd dual = product(inverse(), values_);
  sample_predictions found{values_, values_, Eigen::VectorXd(size())};
  for (Eigen::Index i = 0; i < size(); ++i) {
    for (Eigen::Index c = 0; c < channels(); ++c) found.mean(i, c) -= dual(i, c) / inverse()(i, i);
    found.deviation[i] = std::sqrt(1.0 / inverse()(i, i));
  }
  return found;
}

GONIO_INLINE sample_predictions sample_process::predicted_without(std::span<const Eigen::Index> positions) const {
  std::vector<Eigen::Index> others;
  for (Eigen::Index i = 0; i < size(); ++i)
    if (std::ranges::find(positions, i) == positions.end()) others.push_back(i);
  const cholesky by = detail::factors_of(detail::part_of(covariance(), others, others));
  const Eigen::MatrixXd half = by.solve_lower(detail::part_of(covariance(), others, positions));
  sample_predictions found{detail::rows_of_matrix(values_, positions),
                           product(half.transpose(), by.solve_lower(detail::rows_of_matrix(values_, others))),
                           Eigen::VectorXd(std::ssize(positions))};
  for (Eigen::Index i = 0; i < std::ssize(positions); ++i)
    found.deviation[i] =
        std::sqrt(std::max(covariance()(positions[i], positions[i]) - detail::squared_norm(half.col(i)), 0.0));
  return found;
}

GONIO_INLINE double sample_process::scale() const {
  const auto n = static_cast<double>(size()), over = static_cast<double>(channels());
  return (known_before + detail::squared_norm(factors().solve_lower(values_)) / over) / (known_before + n);
}

GONIO_INLINE double sample_process::scale_of_material() const {
  const Eigen::MatrixXd without_errors = expected().among(at()), dual = product(inverse(), values_);
  const Eigen::MatrixXd explained = product(without_errors, dual);
  const double squares = dot(dual.data(), explained.data(), dual.size()),
               known = dot(inverse().data(), without_errors.data(), without_errors.size());
  return (known_before + squares / static_cast<double>(channels())) / (known_before + known);
}

GONIO_INLINE Eigen::VectorXd sample_process::deviations(const located_rows& others) const {
  const Eigen::MatrixXd half = factors().solve_lower(expected().between(at(), others));
  Eigen::VectorXd all = deviations_before(others);
  for (Eigen::Index i = 0; i < all.size(); ++i)
    all[i] = std::sqrt(std::max(all[i] * all[i] - detail::squared_norm(half.col(i)), 0.0));
  return all;
}

GONIO_INLINE Eigen::VectorXd sample_process::deviations_before(const located_rows& others) const {
  const discrepancy_model& model = expected().model;
  Eigen::VectorXd all(others.size());
  for (Eigen::Index i = 0; i < all.size(); ++i) {
    const half_difference& angles = others.angles[i];
    double squares = 0.0;
    for (Eigen::Index j = 0; j < others.rows.cols(); ++j) squares += others.rows(i, j) * others.rows(i, j);
    double variance = squares / expected().observations + model.variance + error_variance_at(model, angles);
    if (expected().doubts)
      variance += model.doubt.variance * detail::fresnel_factor(model.doubt, angles) +
                  detail::doubted_error_variance(model, angles);
    all[i] = std::sqrt(variance);
  }
  return all;
}

GONIO_INLINE process_prediction sample_process::predict(const located_rows& others,
                                                        Eigen::MatrixXd covariance_before) const {
  const Eigen::MatrixXd with = expected().between(others, at());
  const Eigen::MatrixXd gain = factors().solve(with.transpose());
  process_prediction found{product(gain.transpose(), values_), std::move(covariance_before)};
  add_scaled(-1.0, product(with, gain), found.covariance);
  return found;
}

GONIO_INLINE gonio::familiarity sample_process::familiarity() const {
  const Eigen::MatrixXd dual = factors().solve(values_);
  const double all = dot(values_.data(), dual.data(), dual.size());
  // Divide y' K^-1 y into the contributions of the terms of K.
  const double components = detail::squared_norm(product(at().rows.transpose(), dual)) / expected().observations;
  const Eigen::VectorXd errors = errors_of(*shared_);
  double by_errors = 0.0;
  for (Eigen::Index c = 0; c < dual.cols(); ++c)
    for (Eigen::Index i = 0; i < dual.rows(); ++i) by_errors += errors[i] * dual(i, c) * dual(i, c);
  const double discrepancy = all - components - by_errors;
  const auto n = static_cast<double>(size()), over = static_cast<double>(channels());
  return {.scale = all / over / n,
          .p_value = f_tail(all / over / n, n, 4.0),
          .components = all > 0.0 ? components / all : 0.0,
          .discrepancy = all > 0.0 ? discrepancy / all : 0.0,
          .errors = all > 0.0 ? by_errors / all : 1.0};
}

}  // namespace gonio
