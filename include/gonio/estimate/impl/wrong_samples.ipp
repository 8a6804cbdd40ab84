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

/// Returns the mean of the three channels: n x 1.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd brightness_of(const Eigen::MatrixXd& values) {
  Eigen::MatrixXd means(values.rows(), 1);
  for (Eigen::Index i = 0; i < values.rows(); ++i) means(i, 0) = (values(i, 0) + values(i, 1) + values(i, 2)) / 3.0;
  return means;
}

/// Returns two orthonormal contrasts between the three channels: n x 2.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd contrasts_of(const Eigen::MatrixXd& values) {
  Eigen::MatrixXd contrasts(values.rows(), 2);
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    contrasts(i, 0) = (values(i, 0) - values(i, 1)) / std::sqrt(2.0);
    contrasts(i, 1) = (values(i, 0) + values(i, 1) - 2.0 * values(i, 2)) / std::sqrt(6.0);
  }
  return contrasts;
}

/// Returns the standard deviation of a shared deviation in the highlight at some angles, relative to the one at theta_h
/// = 0.
[[nodiscard]] inline double highlight_share(const half_difference& angles, double reach) noexcept {
  return 1.0 / (1.0 + std::pow(angles.theta_h / reach, 2));
}

/// Returns the covariance between the shared deviation at some angles and at other angles.
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

/// Returns the covariance of right samples, for a scale of 1.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd covariance_of(const sample_process& samples, const shared_deviation& shared,
                                                         const rejection_rule& rule) {
  Eigen::MatrixXd found = samples.covariance();
  const std::vector<half_difference>& angles = samples.at().angles;
  add_scaled(1.0, shared_covariance(shared, rule, angles, angles), found);
  for (Eigen::Index i = 0; i < samples.size(); ++i)
    found(i, i) += rule.grazing_variance * grazing_share(angles[i], rule.grazing_reach);
  return found;
}

/// A set of samples, one property of which is wrong, and the logarithm of the set's probability up to a constant. The
/// unknown scale of all variances makes the likelihood Student's t: if the model is poor, all samples disagree a
/// little, and none is an outlier.
class wrong_sample_set {
 public:
  wrong_sample_set(std::shared_ptr<const Eigen::MatrixXd> covariance, const Eigen::MatrixXd& values,
                   const rejection_rule& rule, const property_rule& property, std::vector<bool> wrong)
      : covariance_(std::move(covariance)),
        property_(property),
        expected_number_(rule.expected_number),
        penalty_(rule.penalty),
        is_wrong_(std::move(wrong)),
        size_(std::ranges::count(is_wrong_, true)) {
    const cholesky known = factors();
    inverse_ = known.inverse();
    log_determinant_ = known.log_determinant();
    dual_ = product(inverse_, values);
    squares_ = dot(dual_.data(), values.data(), values.size()) / columns();
  }

  [[nodiscard]] Eigen::Index samples() const noexcept { return std::ssize(is_wrong_); }
  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  [[nodiscard]] bool contains(Eigen::Index i) const { return is_wrong_[i]; }
  [[nodiscard]] const std::vector<bool>& members() const noexcept { return is_wrong_; }

  /// Returns the Cholesky factors of the covariance plus the error variances of wrong samples. O(n^3) for n samples.
  [[nodiscard]] cholesky factors() const {
    Eigen::MatrixXd covariance = *covariance_;
    for (Eigen::Index i = 0; i < covariance.rows(); ++i)
      if (is_wrong_[i]) covariance(i, i) += property_.error_variance;
    return factors_of(covariance);
  }

  [[nodiscard]] double scale() const { return with_expected(squares_) / (degrees() + count()); }

  [[nodiscard]] double log_probability() const {
    const auto k = static_cast<double>(size_);
    return log_likelihood(with_expected(squares_), log_determinant_) + std::lgamma(expected_number_ + k) +
           std::lgamma(1.0 + count() - k) - penalty_ * k;
  }

  /// Returns the logarithm of the odds that one more sample is wrong, given the number of samples in the set.
  [[nodiscard]] double prior_log_odds() const { return prior_log_odds(size_); }

  /// Returns the increase of the log-probability if a sample outside of the set joins it, or a member leaves it. O(1).
  [[nodiscard]] double gain(Eigen::Index i) const {
    const change by = change_by(i, is_wrong_[i] ? -1.0 : 1.0);
    const double before = with_expected(squares_);
    return log_likelihood((before - by.squares) / before, by.log_determinant) +
           (is_wrong_[i] ? -prior_log_odds(size_ - 1) : prior_log_odds(size_));
  }

  /// Returns the logarithm of the odds that a sample is wrong, assuming that the set is right about all other samples.
  [[nodiscard]] double log_odds(Eigen::Index i) const { return is_wrong_[i] ? -gain(i) : gain(i); }

  /// Adds a sample to the set or, if it is a member, removes it, by the Sherman-Morrison formula. O(n^2) for n samples.
  void change_side(Eigen::Index i) {
    const double sign = is_wrong_[i] ? -1.0 : 1.0, error = sign * property_.error_variance;
    const change by = change_by(i, sign);
    squares_ -= by.squares;
    log_determinant_ += by.log_determinant;
    const Eigen::Index n = samples();
    const std::vector<double> column(&inverse_(0, i), &inverse_(0, i) + n);
    std::vector<double> scaled_column(column);
    for (double& value : scaled_column) value *= error / (1.0 + error * column[i]);
    for (Eigen::Index c = 0; c < dual_.cols(); ++c) add_scaled(-dual_(i, c), scaled_column.data(), &dual_(0, c), n);
    for (Eigen::Index j = 0; j < n; ++j) add_scaled(-column[j], scaled_column.data(), &inverse_(0, j), n);
    size_ += is_wrong_[i] ? -1 : 1;
    is_wrong_[i] = !is_wrong_[i];
  }

  /// Returns the sample whose change has the largest gain. If the set may not grow, considers only its members; returns
  /// -1 if it has none.
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
  struct change {
    double squares, log_determinant;
  };

  [[nodiscard]] double count() const noexcept { return static_cast<double>(samples()); }
  [[nodiscard]] double columns() const noexcept { return static_cast<double>(dual_.cols()); }
  [[nodiscard]] double degrees() const noexcept { return property_.degrees + property_.degrees_per_sample * count(); }
  /// Adds the sum of squares that is expected before any sample.
  [[nodiscard]] double with_expected(double squares) const noexcept { return degrees() * property_.scale + squares; }
  [[nodiscard]] double prior_log_odds(Eigen::Index wrong) const {
    const auto k = static_cast<double>(wrong);
    return std::log((expected_number_ + k) / (count() - k)) - penalty_;
  }
  [[nodiscard]] double log_likelihood(double squares, double log_determinant) const {
    return -0.5 * ((degrees() + count()) * std::log(squares) + log_determinant);
  }

  /// Returns the changes of y' K^-1 y and of log |K| if a sample's error variance is added or removed, by the matrix
  /// determinant lemma.
  [[nodiscard]] change change_by(Eigen::Index i, double sign) const {
    const double error = sign * property_.error_variance, growth = 1.0 + error * inverse_(i, i);
    double squares = 0.0;
    for (Eigen::Index c = 0; c < dual_.cols(); ++c) squares += dual_(i, c) * dual_(i, c);
    return {error * squares / growth / columns(), std::log(growth)};
  }

  std::shared_ptr<const Eigen::MatrixXd> covariance_;
  property_rule property_;
  double expected_number_, penalty_;
  std::vector<bool> is_wrong_;
  Eigen::Index size_;
  Eigen::MatrixXd inverse_, dual_;                ///< K^-1, and K^-1 y
  double log_determinant_ = 0.0, squares_ = 0.0;  ///< of K, and y' K^-1 y, averaged over the columns of y
};

/// The smallest gain that counts; smaller gains are rounding errors.
inline constexpr double least_gain = 1e-9;

/// Tries pairs of samples, and adds the best pair if its gain is positive: two wrong samples may hide each other.
/// Returns true if a pair was added.
[[nodiscard]] GONIO_INLINE bool add_pair(wrong_sample_set& wrong) {
  // Try fewer candidates if there are many samples: then right neighbours usually reveal each wrong sample.
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

/// Changes the set, one sample at a time, while that makes the set more probable. If no single change does, adds a
/// pair.
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
  const double brightness = rule.brightness.error_variance, colour = rule.colour.error_variance;
  if (!(brightness > 0.0 && std::isfinite(brightness)) || !(colour > 0.0 && std::isfinite(colour)))
    refuse({"the error variances of wrong samples must be positive and finite, not ", brightness, " and ", colour});
}

/// Returns the largest number of wrong samples among n.
[[nodiscard]] inline Eigen::Index most_wrong(const rejection_rule& rule, Eigen::Index n) {
  return std::max<Eigen::Index>(static_cast<Eigen::Index>(rule.largest_share * static_cast<double>(n)), 1);
}

/// Searches for the most probable combination of a set of wrong samples and a shared deviation.
class set_search {
 public:
  set_search(const sample_process& samples, const Eigen::MatrixXd& values, const rejection_rule& rule,
             const property_rule& property, std::span<const std::vector<bool>> starts)
      : samples_(samples),
        values_(values),
        rule_(rule),
        property_(property),
        starts_(starts.begin(), starts.end()),
        most_(most_wrong(rule, samples.size())) {
    starts_.insert(starts_.begin(), std::vector<bool>(samples.size(), false));
    // Choose the variance everywhere first, and then the additional variance in the highlight.
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
    const auto covariance = std::make_shared<const Eigen::MatrixXd>(covariance_of(samples_, with, rule_));
    for (const std::vector<bool>& start : starts_) {
      wrong_sample_set found(covariance, values_, rule_, property_, start);
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
  const property_rule& property_;
  std::vector<std::vector<bool>> starts_;
  Eigen::Index most_;
  double penalty_ = 0.0;
};

/// Returns the probability that brightness or colour of each sample is wrong. `colour` is empty for grey samples.
[[nodiscard]] GONIO_INLINE Eigen::VectorXd probability_of_either(const Eigen::VectorXd& brightness,
                                                                 const Eigen::VectorXd& colour) {
  Eigen::VectorXd found(brightness.size());
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    double right = 1.0 / (1.0 + std::exp(brightness[i]));
    if (colour.size() > 0) right *= 1.0 / (1.0 + std::exp(colour[i]));
    found[i] = 1.0 - right;
  }
  return found;
}

}  // namespace detail

GONIO_INLINE judged_samples judge_samples(const sample_process& samples, const rejection_rule& rule,
                                          std::span<const std::vector<bool>> starts) {
  detail::require_possible(rule);
  const Eigen::Index n = samples.size();
  judged_samples found;
  found.probabilities_ = Eigen::VectorXd::Zero(n);
  found.rule_ = rule;
  if (n < 3) return found;
  found.expected_ = samples.expected();
  found.at_ = samples.at();
  const auto judged = [&](const property_rule& property, Eigen::MatrixXd values) {
    const detail::set_search search(samples, values, rule, property, starts);
    const detail::wrong_sample_set& set = *search.best;
    Eigen::VectorXd log_odds(n);
    for (Eigen::Index i = 0; i < n; ++i) log_odds[i] = set.log_odds(i);
    return judged_samples::judged_property{property,      std::move(values), std::move(log_odds), set.factors(),
                                           search.shared, set.scale(),       set.prior_log_odds()};
  };
  found.brightness_ = judged(rule.brightness, detail::brightness_of(samples.values()));
  Eigen::MatrixXd contrasts = detail::contrasts_of(samples.values());
  if (detail::squared_norm(contrasts) > 0.0) found.colour_ = judged(rule.colour, std::move(contrasts));
  const Eigen::VectorXd &brightness = found.brightness_->log_odds,
                        colour = found.colour_ ? found.colour_->log_odds : Eigen::VectorXd{};
  found.probabilities_ = detail::probability_of_either(brightness, colour);
  // List the wrong samples, the most certain first. If there are too many, set the probability of the rest to one half.
  std::vector<std::pair<double, Eigen::Index>> wrong;
  for (Eigen::Index i = 0; i < n; ++i)
    if (found.probabilities_[i] > 0.5)
      wrong.emplace_back(-(colour.size() > 0 ? std::max(brightness[i], colour[i]) : brightness[i]), i);
  const Eigen::Index most = detail::most_wrong(rule, n);
  for (const Eigen::Index i : in_order(std::move(wrong)))
    if (std::ssize(found.wrong_) < most)
      found.wrong_.push_back({i, found.probabilities_[i]});
    else
      found.probabilities_[i] = 0.5;
  return found;
}

GONIO_INLINE Eigen::VectorXd judged_samples::log_odds(const judged_property& known, const located_rows& others,
                                                      const Eigen::MatrixXd& values,
                                                      const Eigen::VectorXd& error_variances,
                                                      const Eigen::MatrixXd& covariance) const {
  Eigen::MatrixXd with = covariance;
  add_scaled(1.0, detail::shared_covariance(known.shared, rule_, at_.angles, others.angles), with);
  const Eigen::MatrixXd half = known.factors.solve_lower(with),
                        predicted = product(half.transpose(), known.factors.solve_lower(known.values));
  Eigen::VectorXd found = Eigen::VectorXd::Constant(others.size(), known.prior_log_odds);
  for (Eigen::Index i = 0; i < others.size(); ++i) {
    const half_difference& angles = others.angles[i];
    const double highlight = detail::highlight_share(angles, rule_.highlight_reach);
    double before = expected_.model.variance + known.shared.everywhere +
                    known.shared.in_highlight * highlight * highlight +
                    rule_.grazing_variance * grazing_share(angles, rule_.grazing_reach);
    for (Eigen::Index k = 0; k < others.rows.cols(); ++k)
      before += others.rows(i, k) * others.rows(i, k) / expected_.observations;
    const double variance = std::max(before - detail::squared_norm(half.col(i)), 0.0) + error_variances[i],
                 wrong_variance = variance + known.rule.error_variance;
    // Compare two densities of the value: that of a wrong sample and that of a right sample.
    for (Eigen::Index c = 0; c < values.cols(); ++c) {
      const double off = values(i, c) - predicted(i, c);
      found[i] +=
          0.5 / static_cast<double>(values.cols()) *
          (off * off / known.scale * (1.0 / variance - 1.0 / wrong_variance) - std::log(wrong_variance / variance));
    }
  }
  return found;
}

GONIO_INLINE Eigen::VectorXd judged_samples::probabilities(const located_rows& others, const Eigen::MatrixXd& mapped,
                                                           const Eigen::VectorXd& error_variances) const {
  if (!brightness_) return Eigen::VectorXd::Zero(others.size());
  const Eigen::MatrixXd covariance = expected_.between(at_, others);
  const auto judged = [&](const judged_property& known, const Eigen::MatrixXd& values) {
    return log_odds(known, others, values, error_variances, covariance);
  };
  return detail::probability_of_either(judged(*brightness_, detail::brightness_of(mapped)),
                                       colour_ ? judged(*colour_, detail::contrasts_of(mapped)) : Eigen::VectorXd{});
}

}  // namespace gonio
