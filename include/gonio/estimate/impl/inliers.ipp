#pragma once
/// Bodies of estimate/inliers.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/estimate/inliers.hpp>
#include <gonio/solve/product.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

/// Numbers in the order of what belongs to them, and of themselves where that is the same.
[[nodiscard]] GONIO_INLINE std::vector<Eigen::Index> in_order(std::vector<std::pair<double, Eigen::Index>> keyed) {
  std::sort(keyed.begin(), keyed.end());
  std::vector<Eigen::Index> ordered;
  for (const auto& [key, number] : keyed) ordered.push_back(number);
  return ordered;
}

/// A set of wrong samples, and the logarithm of its probability up to a constant. The mean of the three channels and
/// their two contrasts are apart: the error of a wrong sample has other variances in these. The scale of all variances
/// has an inverse gamma distribution of ten degrees of freedom, which makes the likelihood Student's. The channels of a
/// material are alike: the mean of their likelihoods counts, not the product.
class wrong_sample_set {
 public:
  wrong_sample_set(const sample_process& samples, const rejection_rule& rule)
      : mean_{3.0 * std::pow(rule.common_error, 2) + std::pow(rule.channel_error, 2), samples.inverse(), {}},
        contrasts_{std::pow(rule.channel_error, 2), mean_.inverse, {}},
        is_wrong_(samples.size(), false),
        log_odds_(log_odds_of_one(rule, samples.size())) {
    const Eigen::MatrixXd dual = product(mean_.inverse, samples.values());
    mean_.dual.resize(dual.rows(), 1);
    contrasts_.dual.resize(dual.rows(), 2);
    for (Eigen::Index i = 0; i < dual.rows(); ++i) {
      mean_.dual(i, 0) = (dual(i, 0) + dual(i, 1) + dual(i, 2)) / std::sqrt(3.0);
      contrasts_.dual(i, 0) = (dual(i, 0) - dual(i, 1)) / std::sqrt(2.0);
      contrasts_.dual(i, 1) = (dual(i, 0) + dual(i, 1) - 2.0 * dual(i, 2)) / std::sqrt(6.0);
    }
    squares_ = dot(dual.data(), samples.values().data(), dual.size());
  }

  [[nodiscard]] Eigen::Index size() const noexcept { return std::ranges::count(is_wrong_, true); }
  [[nodiscard]] bool contains(Eigen::Index i) const { return is_wrong_[i]; }

  /// By how much the logarithm grows if a sample changes sides. O(1).
  [[nodiscard]] double gain(Eigen::Index i) const {
    const double sign = is_wrong_[i] ? -1.0 : 1.0;
    const change mean = mean_.change_by(i, sign), contrasts = contrasts_.change_by(i, sign);
    constexpr double degrees = sample_process::known_before, channels = 3.0;
    const auto n = static_cast<double>(is_wrong_.size());
    const double before = degrees + squares_ / channels;
    const double after = before - (mean.squares + contrasts.squares) / channels;
    return -0.5 * (degrees + n) * std::log(after / before) -
           0.5 * (mean.log_determinant + contrasts.log_determinant) / channels + sign * log_odds_;
  }

  /// That a sample of the set is wrong, if all others are as the set says.
  [[nodiscard]] double probability(Eigen::Index i) const { return 1.0 / (1.0 + std::exp(gain(i))); }

  /// Moves a sample to the other side. O(n^2).
  void change_side(Eigen::Index i) {
    const double sign = is_wrong_[i] ? -1.0 : 1.0;
    squares_ -= mean_.change_by(i, sign).squares + contrasts_.change_by(i, sign).squares;
    mean_.update(i, sign);
    contrasts_.update(i, sign);
    is_wrong_[i] = !is_wrong_[i];
  }

  /// The sample of the largest gain, of those that may change sides.
  [[nodiscard]] Eigen::Index best_change(bool may_grow) const {
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < std::ssize(is_wrong_); ++i)
      if ((may_grow || is_wrong_[i]) && (best < 0 || gain(i) > gain(best))) best = i;
    return best;
  }

 private:
  [[nodiscard]] static double log_odds_of_one(const rejection_rule& rule, Eigen::Index samples) {
    const double probability = std::min(rule.expected_number / static_cast<double>(samples), 0.5);
    return std::log(probability / (1.0 - probability));
  }

  struct change {
    double squares, log_determinant;
  };

  /// Channels that are treated alike: the inverse of their covariance, and that times their values.
  struct channel_group {
    double error_variance;
    Eigen::MatrixXd inverse, dual;

    /// The matrix determinant lemma, for the covariance with or without a sample's error variance.
    [[nodiscard]] change change_by(Eigen::Index i, double sign) const {
      const double error = sign * error_variance, growth = 1.0 + error * inverse(i, i);
      double squares = 0.0;
      for (Eigen::Index c = 0; c < dual.cols(); ++c) squares += dual(i, c) * dual(i, c);
      return {error * squares / growth, static_cast<double>(dual.cols()) * std::log(growth)};
    }

    /// The formula of Sherman and Morrison.
    void update(Eigen::Index i, double sign) {
      const double error = sign * error_variance;
      const Eigen::Index n = inverse.rows();
      const std::vector<double> column(&inverse(0, i), &inverse(0, i) + n);
      std::vector<double> scaled(column);
      for (double& value : scaled) value *= error / (1.0 + error * column[i]);
      for (Eigen::Index c = 0; c < dual.cols(); ++c) add_scaled(-dual(i, c), scaled.data(), &dual(0, c), n);
      for (Eigen::Index j = 0; j < n; ++j) add_scaled(-column[j], scaled.data(), &inverse(0, j), n);
    }
  };

  channel_group mean_, contrasts_;
  std::vector<bool> is_wrong_;
  double squares_ = 0.0, log_odds_;
};

/// Adds the pair of samples whose gain is the largest, if it is positive: two wrong samples may hide each other.
[[nodiscard]] inline bool add_pair(wrong_sample_set& wrong, Eigen::Index samples) {
  constexpr Eigen::Index candidates = 12;
  std::vector<std::pair<double, Eigen::Index>> by_gain;
  for (Eigen::Index i = 0; i < samples; ++i)
    if (!wrong.contains(i)) by_gain.emplace_back(-wrong.gain(i), i);
  const std::vector<Eigen::Index> first = in_order(std::move(by_gain));
  double best_gain = 0.0;
  std::array<Eigen::Index, 2> best{};
  for (Eigen::Index i = 0; i < std::min(candidates, std::ssize(first)); ++i) {
    wrong_sample_set with = wrong;
    with.change_side(first[i]);
    const Eigen::Index second = with.best_change(true);
    const double gain = wrong.gain(first[i]) + with.gain(second);
    if (second == first[i] || with.contains(second) || !(gain > best_gain)) continue;
    best_gain = gain;
    best = {first[i], second};
  }
  if (!(best_gain > 0.0)) return false;
  for (const Eigen::Index i : best) wrong.change_side(i);
  return true;
}

inline void require_possible(const rejection_rule& rule) {
  if (!(rule.least_probability > 0.0 && rule.least_probability < 1.0) ||
      !(rule.largest_share >= 0.0 && rule.largest_share < 1.0))
    refuse({"the rule by which samples are left out needs a probability and a share below 1, not ",
            rule.least_probability, " and ", rule.largest_share});
  if (!(rule.expected_number > 0.0 && std::isfinite(rule.expected_number)))
    refuse({"the expected number of wrong samples must be positive and finite, not ", rule.expected_number});
  if (!(rule.common_error > 0.0 && std::isfinite(rule.common_error)) ||
      !(rule.channel_error > 0.0 && std::isfinite(rule.channel_error)))
    refuse({"the errors of wrong samples need positive and finite deviations, not ", rule.common_error, " and ",
            rule.channel_error});
}

}  // namespace detail

GONIO_INLINE std::vector<wrong_sample> find_wrong_samples(const sample_process& samples, const rejection_rule& rule) {
  detail::require_possible(rule);
  const Eigen::Index n = samples.size();
  if (n < 3) return {};
  const auto most = std::max<Eigen::Index>(static_cast<Eigen::Index>(rule.largest_share * static_cast<double>(n)), 1);
  detail::wrong_sample_set wrong(samples, rule);
  // Change sides while that makes the set more probable; in pairs where no single change does.
  for (bool improves = true; improves;) {
    const Eigen::Index i = wrong.best_change(wrong.size() < most);
    improves = i >= 0 && wrong.gain(i) > 0.0;
    if (improves)
      wrong.change_side(i);
    else if (wrong.size() + 2 <= most)
      improves = detail::add_pair(wrong, n);
  }
  // Keep the samples about which there is doubt, the most doubtful first.
  std::vector<Eigen::Index> members;
  for (Eigen::Index i = 0; i < n; ++i)
    if (wrong.contains(i)) members.push_back(i);
  while (!members.empty()) {
    const auto doubtful = std::ranges::min_element(members, {}, [&](Eigen::Index i) { return wrong.probability(i); });
    if (wrong.probability(*doubtful) >= rule.least_probability) break;
    wrong.change_side(*doubtful);
    members.erase(doubtful);
  }
  std::vector<std::pair<double, Eigen::Index>> by_probability;
  for (const Eigen::Index i : members) by_probability.emplace_back(-wrong.probability(i), i);
  std::vector<wrong_sample> found;
  for (const Eigen::Index i : detail::in_order(std::move(by_probability))) found.push_back({i, wrong.probability(i)});
  return found;
}

GONIO_INLINE std::vector<Eigen::Index> inliers::kept() const {
  constexpr double least_weight = 0.01;
  std::vector<Eigen::Index> positions;
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    if (weights[i] >= least_weight) positions.push_back(i);
  return positions;
}

GONIO_INLINE inliers all_inliers(Eigen::Index n) { return {Eigen::VectorXd::Ones(n), {}}; }

GONIO_INLINE Eigen::VectorXd limit_outliers(const Eigen::VectorXd& inlier_weights) {
  const Eigen::Index n = inlier_weights.size();
  if (n == 0) return inlier_weights;
  const auto most = static_cast<Eigen::Index>(largest_outlier_share(n) * static_cast<double>(n));
  const double least_inlier = nth_smallest(std::vector<double>(inlier_weights.begin(), inlier_weights.end()), most);
  Eigen::VectorXd raised = Eigen::VectorXd::Ones(n);
  for (Eigen::Index i = 0; i < n && least_inlier > 0.0; ++i)
    raised[i] = std::min(inlier_weights[i] / least_inlier, 1.0);
  return raised;
}

GONIO_INLINE located_samples weighted(const located_samples& samples, const inliers& found) {
  const std::vector<Eigen::Index> kept = found.kept();
  located_samples some = samples.subset(kept);
  for (Eigen::Index c = 0; c < some.weights.cols(); ++c)
    for (Eigen::Index i = 0; i < some.size(); ++i) some.weights(i, c) *= found.weights[kept[i]];
  return some;
}

GONIO_INLINE inliers detail::weighed_inliers(Eigen::VectorXd weights) {
  inliers found{std::move(weights), {}};
  std::vector<std::pair<double, Eigen::Index>> by_weight;
  for (Eigen::Index i = 0; i < found.weights.size(); ++i)
    if (found.weights[i] < 0.5) by_weight.emplace_back(found.weights[i], i);
  found.rejected = in_order(std::move(by_weight));
  found.outlier_share = 1.0 - found.weights.sum() / static_cast<double>(found.weights.size());
  return found;
}

}  // namespace gonio
