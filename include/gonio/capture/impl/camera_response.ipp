#pragma once
/// Bodies of capture/camera_response.hpp.

#include <gonio/capture/camera_response.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/solve/quadratic_program.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE camera_response::camera_response(std::uint16_t largest_count, Eigen::VectorXd log_exposures,
                                              double smallest_known_count)
    : largest_(largest_count), smallest_known_(smallest_known_count), values_(std::move(log_exposures)) {
  if (values_.size() < 2) throw error("a camera's response needs at least two values");
  if (values_.size() > largest_)
    throw error("a camera of " + std::to_string(largest_) + " counts has no response of " +
                std::to_string(values_.size()) + " values");
  if (!values_.allFinite()) throw error("a camera's response must be finite");
  for (Eigen::Index k = 1; k < values_.size(); ++k)
    if (values_[k] < values_[k - 1])
      throw error("a camera's response falls from value " + std::to_string(k) +
                  " to the next: more light cannot "
                  "give less counts");
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
  if (!(rise > 0.0)) return 0.0;  // the first line is flat: what is darker than it has no count
  const double log_ratio = std::log1p(1.0 / static_cast<double>(left + 1));
  return spacing() * static_cast<double>(left + 1) * std::exp((wanted - values_[left]) / rise * log_ratio);
}

GONIO_INLINE std::pair<Eigen::Index, double> camera_response::place_of(double count, double spacing,
                                                                       Eigen::Index knots) noexcept {
  const double position = count / spacing;
  const Eigen::Index left = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(position) - 1, 0, knots - 2);
  const auto knot = static_cast<double>(left + 1);
  return {left, std::log(position / knot) / std::log1p(1.0 / knot)};
}

}  // namespace gonio

namespace gonio::detail {

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

GONIO_INLINE response_equations::response_equations(Eigen::Index knots, double spacing, double saturation)
    : gram_(Eigen::MatrixXd::Zero(knots, knots)),
      moment_(Eigen::VectorXd::Zero(knots)),
      spacing_(spacing),
      saturation_(saturation) {}

GONIO_INLINE Eigen::VectorXd never_falling(Eigen::VectorXd values) {
  for (Eigen::Index k = 1; k < values.size(); ++k) values[k] = std::max(values[k], values[k - 1]);
  return values;
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE camera_response estimate_response(const exposure_counts& counts, std::span<const double> times,
                                               std::uint16_t largest_count, const response_options& options) {
  if (counts.cols() != std::ssize(times) || times.size() < 2)
    throw error("a camera's response needs two exposure times or more, and counts for each: not " +
                std::to_string(times.size()) + " and " + std::to_string(counts.cols()));
  for (const double time : times)
    if (!(time > 0.0 && std::isfinite(time)))
      throw error("an exposure time must be positive, not " + std::to_string(time));
  if (largest_count < 3) throw error("a camera of " + std::to_string(largest_count) + " counts has no response");
  for (const double count : counts.reshaped())
    if (!(count >= 0.0 && count <= largest_count))
      throw error("a pixel's count is " + std::to_string(count) + ", expected from 0 to " +
                  std::to_string(largest_count));

  const Eigen::Index knots = std::min<Eigen::Index>(largest_count, camera_response::most_knots);
  detail::response_equations equations(knots, largest_count / static_cast<double>(knots),
                                       options.saturation > 0 ? options.saturation : largest_count);
  const Eigen::VectorXd log_times =
      Eigen::Map<const Eigen::VectorXd>(times.data(), std::ssize(times)).array().log().matrix();
  for (Eigen::Index pixel = 0; pixel < counts.rows(); ++pixel) equations.add(counts.row(pixel), log_times);
  const double total = equations.weight();
  if (!(total > 0.0))
    throw error("no pixel is neither dark nor saturated in two exposures: a camera's response needs such");

  const detail::response_basis basis(knots);
  Eigen::MatrixXd gram = basis.values.transpose() * equations.gram() * basis.values / total;
  gram.diagonal().tail(knots - 2).array() += options.smoothness;
  const linear_constraints never_falls{-basis.slopes, Eigen::VectorXd::Zero(knots - 1)};
  const solution found =
      quadratic_program(never_falls)
          .solve(normal_equations(std::move(gram), basis.values.transpose() * equations.moment() / total));
  return {largest_count, detail::never_falling(basis.values * found.weights.col(0)), equations.smallest_count()};
}

}  // namespace gonio
