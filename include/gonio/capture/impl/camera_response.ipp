#pragma once
/// Bodies of capture/camera_response.hpp.

#include <gonio/capture/camera_response.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/dense.hpp>
#include <gonio/solve/quadratic_program.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::capture {

GONIO_INLINE camera_response::camera_response(std::uint16_t largest_count, Eigen::VectorXd log_exposures,
                                              double smallest_known_count)
    : largest_(largest_count), smallest_known_(smallest_known_count), values_(std::move(log_exposures)) {
  if (values_.size() < 2) refuse("a camera's response needs at least two values");
  if (values_.size() > largest_)
    refuse("a camera of " + std::to_string(largest_) + " counts cannot have a response of " +
           std::to_string(values_.size()) + " values");
  if (!values_.allFinite()) refuse("a camera's response must be finite");
  for (Eigen::Index k = 1; k < values_.size(); ++k)
    if (values_[k] < values_[k - 1])
      refuse("a camera's response falls from value " + std::to_string(k) +
             " to the next: more light cannot "
             "give fewer counts");
  values_.array() -= log_exposure(largest_ / 2.0);
  smallest_known_ = std::max(smallest_known_, spacing());
}

GONIO_INLINE camera_response camera_response::power_law(std::uint16_t largest_count, double gamma) {
  const Eigen::Index knots = std::min<Eigen::Index>(largest_count, most_knots);
  return {largest_count, gamma * Eigen::VectorXd::LinSpaced(knots, 1.0, static_cast<double>(knots)).array().log()};
}

GONIO_INLINE double camera_response::count(double exposure) const noexcept {
  if (!(exposure > 0.0)) return 0.0;
  const double wanted = std::log(exposure);
  if (wanted >= values_[values_.size() - 1]) return largest_;
  const auto above = std::lower_bound(values_.begin(), values_.end(), wanted) - values_.begin();
  const Eigen::Index left = std::max<Eigen::Index>(above - 1, 0);
  const double rise = values_[left + 1] - values_[left];
  if (!(rise > 0.0)) return 0.0;  // the first segment is flat: no count belongs to a lower exposure
  const double log_ratio = std::log1p(1.0 / static_cast<double>(left + 1));
  return spacing() * static_cast<double>(left + 1) * std::exp((wanted - values_[left]) / rise * log_ratio);
}

GONIO_INLINE std::pair<Eigen::Index, double> camera_response::knot_position(double count, double spacing,
                                                                            Eigen::Index knots) noexcept {
  const double position = count / spacing;
  const Eigen::Index left = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(position) - 1, 0, knots - 2);
  const auto knot = static_cast<double>(left + 1);
  return {left, std::log(position / knot) / std::log1p(1.0 / knot)};
}

}  // namespace gonio::capture

namespace gonio::capture::detail {

/// Returns a weight of 0 at both ends of a camera's range and 1 in its middle (Debevec and Malik 1997, Eq. 4).
[[nodiscard]] GONIO_INLINE double hat(double count, double saturation) noexcept {
  return std::max(0.0, 1.0 - std::abs(2.0 * count / saturation - 1.0));
}

/// The response as a linear function of unknowns s: the first slope, followed by one bend for each inner knot. Up to a
/// constant, the response at the knots is G s; its slopes with respect to the logarithm of the count are S s. The bends
/// are scaled so that the sum of their squares is the smoothness integral. The penalty is then a multiple of the
/// identity, so the problem is well-conditioned.
struct response_basis {
  Eigen::MatrixXd values, slopes;  ///< G: knots x (knots - 1), S: (knots - 1) x (knots - 1)

  explicit response_basis(Eigen::Index knots);
};

GONIO_INLINE response_basis::response_basis(Eigen::Index knots)
    : values(Eigen::MatrixXd::Zero(knots, knots - 1)), slopes(Eigen::MatrixXd::Zero(knots - 1, knots - 1)) {
  const auto width = [](Eigen::Index interval) { return std::log1p(1.0 / static_cast<double>(interval + 1)); };
  // Sensors bend where they begin to saturate.
  const auto shoulder = [&](Eigen::Index k) {
    return std::pow(std::min(1.0, 2.0 * (1.0 - static_cast<double>(k + 1) / static_cast<double>(knots))), 2);
  };
  slopes.col(0).setOnes();
  for (Eigen::Index k = 1; k < knots - 1; ++k)
    slopes.col(k).tail(knots - 1 - k).setConstant(std::sqrt((width(k - 1) + width(k)) / 2.0) / shoulder(k));
  for (Eigen::Index k = 1; k < knots; ++k) values.row(k) = values.row(k - 1) + width(k - 1) * slopes.row(k - 1);
}

/// The normal equations for the response at its knots. A row is an exposure of a pixel. Each pixel's unknown ln E is
/// eliminated: it is the weighted mean of g - ln t over the pixel's rows.
class response_equations {
 public:
  response_equations(Eigen::Index knots, double spacing, double saturation)
      : gram_(Eigen::MatrixXd::Zero(knots, knots)),
        rhs_(Eigen::VectorXd::Zero(knots)),
        spacing_(spacing),
        saturation_(saturation) {}

  /// Adds a pixel's counts, one for each time.
  void add(const exposure_counts& counts, Eigen::Index pixel, const std::vector<double>& log_times);

  [[nodiscard]] const Eigen::MatrixXd& gram() const noexcept { return gram_; }
  [[nodiscard]] const Eigen::VectorXd& rhs() const noexcept { return rhs_; }
  /// Returns the sum of the weighted squared residuals of a response.
  [[nodiscard]] double squared_residual(const Eigen::VectorXd& values) const {
    return std::max(squares_ + values.dot(gram_ * values - 2.0 * rhs_), 0.0);
  }
  /// Returns the total weight of the rows. Only pixels with at least two rows count, because a single row carries no
  /// information.
  [[nodiscard]] double weight() const noexcept { return weight_; }
  /// Returns the smallest count of pixels with at least two rows.
  [[nodiscard]] double smallest_count() const noexcept { return smallest_count_; }

 private:
  Eigen::MatrixXd gram_;
  Eigen::VectorXd rhs_;
  double spacing_ = 1.0, saturation_ = 1.0, weight_ = 0.0, squares_ = 0.0;
  double smallest_count_ = std::numeric_limits<double>::infinity();
};

GONIO_INLINE void response_equations::add(const exposure_counts& counts, Eigen::Index pixel,
                                          const std::vector<double>& log_times) {
  Eigen::VectorXd row_sum = Eigen::VectorXd::Zero(rhs_.size());
  double weights = 0.0, time_sum = 0.0, squares = 0.0, darkest = smallest_count_;
  int rows = 0;
  for (Eigen::Index j = 0; j < counts.cols(); ++j) {
    const double count = counts(pixel, j), log_time = log_times[j];
    const double weight = std::pow(hat(count, saturation_), 2);
    if (!(weight > 0.0)) continue;
    const auto [left, share] = camera_response::knot_position(count, spacing_, rhs_.size());
    const std::array<double, 2> row{1.0 - share, share};
    for (Eigen::Index a = 0; a < 2; ++a) {
      const double weighted = weight * row[a];
      for (Eigen::Index b = 0; b < 2; ++b) gram_(left + a, left + b) += weighted * row[b];
      rhs_[left + a] += weighted * log_time;
      row_sum[left + a] += weighted;
    }
    darkest = std::min(darkest, count);
    time_sum += weight * log_time;
    squares += weight * log_time * log_time;
    weights += weight;
    ++rows;
  }
  if (rows == 0) return;
  for (Eigen::Index k = 0; k < row_sum.size(); ++k)
    if (row_sum[k] != 0.0) gram_.col(k) -= row_sum[k] / weights * row_sum;
  rhs_ -= time_sum / weights * row_sum;
  if (rows < 2) return;
  weight_ += weights;
  squares_ += squares - time_sum * time_sum / weights;
  smallest_count_ = darkest;
}

/// Removes decreases that are due to rounding.
[[nodiscard]] GONIO_INLINE Eigen::VectorXd never_falling(Eigen::VectorXd values) {
  for (Eigen::Index k = 1; k < values.size(); ++k) values[k] = std::max(values[k], values[k - 1]);
  return values;
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE camera_response estimate_response(const exposure_counts& counts, std::span<const double> times,
                                               std::uint16_t largest_count, const response_options& options) {
  if (counts.cols() != std::ssize(times) || times.size() < 2)
    refuse({"a camera's response needs at least two exposure times and a column of counts for each, not ", times.size(),
            " times and ", counts.cols(), " columns"});
  for (const double time : times)
    if (!(time > 0.0 && std::isfinite(time))) refuse("an exposure time must be positive, not " + std::to_string(time));
  if (largest_count < 3)
    refuse("a camera of " + std::to_string(largest_count) + " counts has no response, expected at least 3 counts");
  for (Eigen::Index i = 0; i < counts.size(); ++i)
    if (const double count = counts.data()[i]; !(count >= 0.0 && count <= largest_count))
      refuse("a pixel's count is " + std::to_string(count) + ", expected from 0 to " + std::to_string(largest_count));

  const Eigen::Index knots = std::min<Eigen::Index>(largest_count, camera_response::most_knots);
  detail::response_equations equations(knots, largest_count / static_cast<double>(knots),
                                       options.saturation > 0 ? options.saturation : largest_count);
  std::vector<double> log_times;
  for (const double time : times) log_times.push_back(std::log(time));
  for (Eigen::Index pixel = 0; pixel < counts.rows(); ++pixel) equations.add(counts, pixel, log_times);
  const double total = equations.weight();
  if (!(total > 0.0)) refuse("a camera's response needs pixels that are neither dark nor saturated in two exposures");

  const detail::response_basis basis(knots);
  const Eigen::MatrixXd to_slopes = basis.values.transpose() / total;
  const Eigen::MatrixXd gram = product(product(to_slopes, equations.gram()), basis.values);
  const Eigen::VectorXd rhs = product(to_slopes, equations.rhs());
  const linear_constraints never_falls{-basis.slopes, Eigen::VectorXd::Zero(knots - 1)};
  const auto fit = [&](double smoothness) -> Eigen::VectorXd {
    Eigen::MatrixXd penalised = gram;
    for (Eigen::Index k = 1; k < knots - 1; ++k) penalised(k, k) += smoothness;
    const solution found = quadratic_program(never_falls).solve(normal_equations(std::move(penalised), rhs));
    return detail::never_falling(product(basis.values, found.weights));
  };
  const double residual = equations.squared_residual(fit(options.smoothness)) / total;
  return {largest_count, fit(options.smoothness + residual / (options.expected_bend * total)),
          equations.smallest_count()};
}

}  // namespace gonio::capture
