#pragma once
/// Bodies of estimate/wrong_samples.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/estimate/wrong_samples.hpp>
#include <gonio/solve/product.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace gonio {

namespace detail {

/// Returns the mean of three channels times sqrt(3), and their two contrasts: an orthonormal rotation of the channels.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd mean_and_contrasts(const Eigen::MatrixXd& values) {
  Eigen::MatrixXd turned(values.rows(), 3);
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    turned(i, 0) = (values(i, 0) + values(i, 1) + values(i, 2)) / std::sqrt(3.0);
    turned(i, 1) = (values(i, 0) - values(i, 1)) / std::sqrt(2.0);
    turned(i, 2) = (values(i, 0) + values(i, 1) - 2.0 * values(i, 2)) / std::sqrt(6.0);
  }
  return turned;
}

/// Factors from the variance of the channels' common part to that of their mean times sqrt(3), and of each contrast.
inline constexpr double shared_by_mean = 3.0, shared_by_contrast = 0.1;

/// Returns the factor by which the deviation in a highlight is smaller at some theta_h.
[[nodiscard]] inline double highlight_share(const half_difference& angles, double reach) noexcept {
  return 1.0 / (1.0 + std::pow(angles.theta_h / reach, 2));
}

/// Returns the covariance of a shared deviation at some angles with that at others.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd shared_covariance(const shared_deviation& shared, const rejection_rule& rule,
                                                             std::span<const half_difference> angles,
                                                             std::span<const half_difference> others) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(std::ssize(angles), std::ssize(others));
  if (shared.everywhere > 0.0)
    add_scaled(shared.everywhere, discrepancy_covariance(angles, others, rule.everywhere_lengths), sum);
  if (!(shared.in_highlight > 0.0)) return sum;
  const Eigen::MatrixXd correlation = discrepancy_covariance(angles, others, rule.highlight_lengths);
  for (Eigen::Index j = 0; j < sum.cols(); ++j) {
    const double there = shared.in_highlight * highlight_share(others[j], rule.highlight_reach);
    for (Eigen::Index i = 0; i < sum.rows(); ++i)
      sum(i, j) += there * highlight_share(angles[i], rule.highlight_reach) * correlation(i, j);
  }
  return sum;
}

/// The covariances of right samples by which wrong ones are found: of the channels' mean, and of each contrast.
struct judged_covariances {
  Eigen::MatrixXd mean, contrasts;
};

[[nodiscard]] GONIO_INLINE judged_covariances covariances_of(const sample_process& samples,
                                                             const shared_deviation& shared,
                                                             const rejection_rule& rule) {
  judged_covariances found{samples.covariance(), samples.covariance()};
  const std::vector<half_difference>& angles = samples.at().angles;
  const Eigen::MatrixXd deviation = shared_covariance(shared, rule, angles, angles);
  add_scaled(shared_by_mean, deviation, found.mean);
  add_scaled(shared_by_contrast, deviation, found.contrasts);
  for (Eigen::Index i = 0; i < samples.size(); ++i) {
    const double grazing = rule.grazing_variance * grazing_share(angles[i], rule.grazing_reach);
    found.mean(i, i) += shared_by_mean * grazing;
    found.contrasts(i, i) += shared_by_contrast * grazing;
  }
  return found;
}

/// A set of wrong samples, and the logarithm of its probability up to a constant. The mean of the three channels and
/// their two contrasts are treated separately, because the errors of wrong samples have other variances in these. The
/// scale of all variances has an inverse gamma distribution of n + 10 degrees of freedom, so that the likelihood is
/// Student's: if the model is poor, all samples disagree a little, and none is an outlier. The channels of a material
/// are alike, so the mean of their log-likelihoods counts, not the sum.
class wrong_sample_set {
 public:
  wrong_sample_set(std::shared_ptr<const judged_covariances> covariances, const Eigen::MatrixXd& values,
                   const rejection_rule& rule, std::vector<bool> wrong)
      : covariances_(std::move(covariances)),
        mean_{rule.mean_variance()},
        contrasts_{rule.contrast_variance()},
        is_wrong_(std::move(wrong)),
        size_(std::ranges::count(is_wrong_, true)),
        expected_number_(rule.expected_number) {
    squares_ = mean_.factorise(covariances_->mean, values.leftCols(1), is_wrong_) +
               contrasts_.factorise(covariances_->contrasts, values.rightCols(2), is_wrong_);
  }

  [[nodiscard]] Eigen::Index samples() const noexcept { return std::ssize(is_wrong_); }
  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  [[nodiscard]] bool contains(Eigen::Index i) const { return is_wrong_[i]; }
  [[nodiscard]] const std::vector<bool>& members() const noexcept { return is_wrong_; }

  /// Return the factors of the covariances, with the errors of wrong samples added. O(n^3).
  [[nodiscard]] cholesky mean_factors() const { return mean_.factors(covariances_->mean, is_wrong_); }
  [[nodiscard]] cholesky contrast_factors() const { return contrasts_.factors(covariances_->contrasts, is_wrong_); }

  /// Returns the scale of all variances.
  [[nodiscard]] double scale() const { return (degrees() + squares_ / channels) / (degrees() + count()); }

  [[nodiscard]] double log_probability() const {
    const auto k = static_cast<double>(size_);
    return -0.5 * (degrees() + count()) * std::log(degrees() + squares_ / channels) -
           0.5 * (mean_.log_determinant + contrasts_.log_determinant) / channels + std::lgamma(expected_number_ + k) +
           std::lgamma(1.0 + count() - k);
  }

  /// Returns the log odds that one more sample is wrong, given the number of wrong ones.
  [[nodiscard]] double log_odds() const { return log_odds(size_); }

  /// Returns the gain of the log-probability if a sample changes sides. O(1).
  [[nodiscard]] double gain(Eigen::Index i) const {
    const double sign = is_wrong_[i] ? -1.0 : 1.0;
    const change mean = mean_.change_by(i, sign), contrasts = contrasts_.change_by(i, sign);
    const double before = degrees() + squares_ / channels;
    const double after = before - (mean.squares + contrasts.squares) / channels;
    return -0.5 * (degrees() + count()) * std::log(after / before) -
           0.5 * (mean.log_determinant + contrasts.log_determinant) / channels +
           (is_wrong_[i] ? -log_odds(size_ - 1) : log_odds(size_));
  }

  /// Returns the probability that a sample is wrong, if all others are as in the set.
  [[nodiscard]] double probability(Eigen::Index i) const {
    return 1.0 / (1.0 + std::exp(is_wrong_[i] ? gain(i) : -gain(i)));
  }

  /// Moves a sample to the other side. O(n^2).
  void change_side(Eigen::Index i) {
    const double sign = is_wrong_[i] ? -1.0 : 1.0;
    squares_ -= mean_.change_by(i, sign).squares + contrasts_.change_by(i, sign).squares;
    mean_.update(i, sign);
    contrasts_.update(i, sign);
    size_ += is_wrong_[i] ? -1 : 1;
    is_wrong_[i] = !is_wrong_[i];
  }

  /// Returns the sample whose change of sides has the largest gain. If the set may not grow, only wrong samples may
  /// change.
  [[nodiscard]] Eigen::Index best_change(bool may_grow) const {
    Eigen::Index best = -1;
    double most = 0.0;
    for (Eigen::Index i = 0; i < samples(); ++i) {
      if (!may_grow && !is_wrong_[i]) continue;
      const double here = gain(i);
      if (best < 0 || here > most) {
        best = i;
        most = here;
      }
    }
    return best;
  }

 private:
  static constexpr double channels = 3.0;

  [[nodiscard]] double count() const noexcept { return static_cast<double>(samples()); }
  [[nodiscard]] double degrees() const noexcept { return sample_process::known_before + count(); }
  [[nodiscard]] double log_odds(Eigen::Index wrong) const {
    const auto k = static_cast<double>(wrong);
    return std::log((expected_number_ + k) / (count() - k));
  }

  struct change {
    double squares, log_determinant;
  };

  /// A group of channels that are treated alike: the inverse K^-1 of their covariance, and the dual K^-1 y.
  struct channel_group {
    double error_variance;
    Eigen::MatrixXd inverse = {}, dual = {};
    double log_determinant = 0.0;

    /// Returns the factors of K: the covariance plus the errors of wrong samples.
    [[nodiscard]] cholesky factors(Eigen::MatrixXd covariance, const std::vector<bool>& wrong) const {
      for (Eigen::Index i = 0; i < covariance.rows(); ++i)
        if (wrong[i]) covariance(i, i) += error_variance;
      return factors_of(covariance);
    }

    /// Returns y' K^-1 y.
    double factorise(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& values, const std::vector<bool>& wrong) {
      const cholesky known = factors(covariance, wrong);
      inverse = known.inverse();
      dual = product(inverse, values);
      log_determinant = static_cast<double>(values.cols()) * known.log_determinant();
      return dot(dual.data(), values.data(), values.size());
    }

    /// Returns the changes if a sample's error variance is added or removed, by the matrix determinant lemma.
    [[nodiscard]] change change_by(Eigen::Index i, double sign) const {
      const double error = sign * error_variance, growth = 1.0 + error * inverse(i, i);
      double squares = 0.0;
      for (Eigen::Index c = 0; c < dual.cols(); ++c) squares += dual(i, c) * dual(i, c);
      return {error * squares / growth, static_cast<double>(dual.cols()) * std::log(growth)};
    }

    /// Adds or removes a sample's error variance, by the Sherman-Morrison formula.
    void update(Eigen::Index i, double sign) {
      const double error = sign * error_variance;
      const Eigen::Index n = inverse.rows();
      log_determinant += change_by(i, sign).log_determinant;
      const std::vector<double> column(&inverse(0, i), &inverse(0, i) + n);
      std::vector<double> scaled(column);
      for (double& value : scaled) value *= error / (1.0 + error * column[i]);
      for (Eigen::Index c = 0; c < dual.cols(); ++c) add_scaled(-dual(i, c), scaled.data(), &dual(0, c), n);
      for (Eigen::Index j = 0; j < n; ++j) add_scaled(-column[j], scaled.data(), &inverse(0, j), n);
    }
  };

  std::shared_ptr<const judged_covariances> covariances_;
  channel_group mean_, contrasts_;
  std::vector<bool> is_wrong_;
  Eigen::Index size_;
  double expected_number_, squares_ = 0.0;
};

/// Smaller gains are rounding errors.
inline constexpr double least_gain = 1e-9;

/// Adds the pair of samples with the largest gain, if it is positive: two wrong samples may hide each other.
[[nodiscard]] GONIO_INLINE bool add_pair(wrong_sample_set& wrong) {
  // Among many samples two wrong ones are rarely alone, and their neighbours reveal them: try fewer candidates.
  const Eigen::Index candidates = std::clamp<Eigen::Index>(2400 / wrong.samples(), 2, 12);
  std::vector<std::pair<double, Eigen::Index>> by_gain;
  for (Eigen::Index i = 0; i < wrong.samples(); ++i)
    if (!wrong.contains(i)) by_gain.emplace_back(-wrong.gain(i), i);
  const std::vector<Eigen::Index> first = in_order(std::move(by_gain));
  double best_gain = least_gain;
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
  if (!(best_gain > least_gain)) return false;
  for (const Eigen::Index i : best) wrong.change_side(i);
  return true;
}

/// Changes sides while that makes the set more probable. If no single change does, adds a pair.
GONIO_INLINE void improve(wrong_sample_set& wrong, Eigen::Index most) {
  Eigen::Index changes = 0;
  for (bool improves = true; improves && changes < 3 * wrong.samples(); ++changes) {
    const Eigen::Index i = wrong.best_change(wrong.size() < most);
    improves = i >= 0 && wrong.gain(i) > least_gain;
    if (improves)
      wrong.change_side(i);
    else if (wrong.size() + 2 <= most)
      improves = add_pair(wrong);
  }
}

GONIO_INLINE void require_possible(const rejection_rule& rule) {
  if (!(rule.largest_share >= 0.0 && rule.largest_share < 1.0))
    refuse({"the share of rejected samples must be at least 0 and less than 1, not ", rule.largest_share});
  if (!(rule.expected_number > 0.0 && std::isfinite(rule.expected_number)))
    refuse({"the expected number of wrong samples must be positive and finite, not ", rule.expected_number});
  if (!(rule.common_error > 0.0 && std::isfinite(rule.common_error)) ||
      !(rule.channel_error > 0.0 && std::isfinite(rule.channel_error)))
    refuse({"the deviations of wrong samples must be positive and finite, not ", rule.common_error, " and ",
            rule.channel_error});
}

/// Searches the most probable set of wrong samples, and the shared deviation.
class set_search {
 public:
  set_search(const sample_process& samples, const Eigen::MatrixXd& values, const rejection_rule& rule,
             std::span<const std::vector<bool>> starts)
      : samples_(samples),
        values_(values),
        rule_(rule),
        starts_(starts.begin(), starts.end()),
        most_(std::max<Eigen::Index>(
            static_cast<Eigen::Index>(rule.largest_share * static_cast<double>(samples.size())), 1)) {
    starts_.insert(starts_.begin(), std::vector<bool>(samples.size(), false));
    // Choose the variance everywhere, then in addition the variance in the highlight.
    consider({}, 0.0);
    for (std::size_t i = 0; i < rule.everywhere.size(); ++i)
      consider({rule.everywhere[i], 0.0}, rule.everywhere_penalty * static_cast<double>(i + 1));
    const double everywhere = shared.everywhere, penalty = penalty_;
    for (std::size_t i = 0; i < rule.in_highlight.size(); ++i)
      consider({everywhere, rule.in_highlight[i]}, penalty + rule.highlight_penalty * static_cast<double>(i + 1));
  }

  std::optional<wrong_sample_set> best = {};
  shared_deviation shared = {};

 private:
  void consider(const shared_deviation& with, double penalty) {
    const auto covariances = std::make_shared<const judged_covariances>(covariances_of(samples_, with, rule_));
    for (const std::vector<bool>& start : starts_) {
      wrong_sample_set found(covariances, values_, rule_, start);
      improve(found, most_);
      if (best && !(found.log_probability() - penalty > best->log_probability() - penalty_ + least_gain)) continue;
      best.emplace(std::move(found));
      shared = with;
      penalty_ = penalty;
    }
  }

  const sample_process& samples_;
  const Eigen::MatrixXd& values_;
  const rejection_rule& rule_;
  std::vector<std::vector<bool>> starts_;
  Eigen::Index most_;
  double penalty_ = 0.0;
};

}  // namespace detail

GONIO_INLINE judged_samples judge_samples(const sample_process& samples, const rejection_rule& rule,
                                          std::span<const std::vector<bool>> starts) {
  detail::require_possible(rule);
  const Eigen::Index n = samples.size();
  judged_samples found;
  found.probabilities_ = Eigen::VectorXd::Zero(n);
  found.rule_ = rule;
  if (n < 3) return found;
  found.values_ = detail::mean_and_contrasts(samples.values());
  const detail::set_search search(samples, found.values_, rule, starts);
  const detail::wrong_sample_set& set = *search.best;
  // List them, the least likely to be right first.
  std::vector<std::pair<double, Eigen::Index>> by_gain;
  for (Eigen::Index i = 0; i < n; ++i) {
    found.probabilities_[i] = set.probability(i);
    if (set.contains(i)) by_gain.emplace_back(set.gain(i), i);
  }
  for (const Eigen::Index i : in_order(std::move(by_gain))) found.wrong_.push_back({i, found.probabilities_[i]});
  // Keep everything needed to judge other samples.
  found.shared_ = search.shared;
  found.expected_ = samples.expected();
  found.at_ = samples.at();
  found.scale_ = set.scale();
  found.log_odds_ = set.log_odds();
  found.mean_ = set.mean_factors();
  found.contrasts_ = set.contrast_factors();
  return found;
}

GONIO_INLINE Eigen::VectorXd judged_samples::probabilities(const located_rows& others, const Eigen::MatrixXd& mapped,
                                                           const Eigen::VectorXd& error_variances) const {
  const Eigen::Index p = others.size();
  if (!mean_) return Eigen::VectorXd::Zero(p);
  const Eigen::MatrixXd values = detail::mean_and_contrasts(mapped), with = expected_.between(at_, others),
                        deviation = detail::shared_covariance(shared_, rule_, at_.angles, others.angles);
  std::vector<double> log_ratio(p, log_odds_), squares_of_rows(p, 0.0);
  for (Eigen::Index k = 0; k < others.rows.cols(); ++k)
    for (Eigen::Index i = 0; i < p; ++i) squares_of_rows[i] += others.rows(i, k) * others.rows(i, k);
  // Add the log ratios of the densities of the value if the sample is wrong and if it is right: first for the mean of
  // the channels, then for their contrasts.
  const auto add = [&](const cholesky& factors, double share, double wrong_variance, Eigen::Index first,
                       Eigen::Index count) {
    Eigen::MatrixXd sum = with;
    add_scaled(share, deviation, sum);
    const Eigen::MatrixXd half = factors.solve_lower(sum),
                          known = factors.solve_lower(values_.middleCols(first, count)),
                          predicted = product(half.transpose(), known);
    for (Eigen::Index i = 0; i < p; ++i) {
      const half_difference& angles = others.angles[i];
      const double highlight = detail::highlight_share(angles, rule_.highlight_reach);
      const double before = squares_of_rows[i] / expected_.observations + expected_.model.variance +
                            share * (shared_.everywhere + shared_.in_highlight * highlight * highlight +
                                     rule_.grazing_variance * grazing_share(angles, rule_.grazing_reach));
      const double variance = std::max(before - detail::squared_norm(half.col(i)), 0.0) + error_variances[i];
      for (Eigen::Index c = first; c < first + count; ++c) {
        const double off = values(i, c) - predicted(i, c - first);
        log_ratio[i] += 0.5 / 3.0 *
                        (off * off / scale_ * (1.0 / variance - 1.0 / (variance + wrong_variance)) -
                         std::log1p(wrong_variance / variance));
      }
    }
  };
  add(*mean_, detail::shared_by_mean, rule_.mean_variance(), 0, 1);
  add(*contrasts_, detail::shared_by_contrast, rule_.contrast_variance(), 1, 2);
  Eigen::VectorXd found(p);
  for (Eigen::Index i = 0; i < p; ++i) found[i] = 1.0 / (1.0 + std::exp(-log_ratio[i]));
  return found;
}

}  // namespace gonio
