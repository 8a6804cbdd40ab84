#pragma once
/// Bodies of capture/reference_reflectance.hpp.

#include <gonio/capture/reference_reflectance.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/rgb.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace gonio::capture::detail {

GONIO_INLINE void require_ascending(const std::vector<double>& angles, const char* name) {
  constexpr double right_angle = std::numbers::pi / 2.0;
  for (const double angle : angles)
    if (!(angle >= 0.0 && angle <= right_angle * (1.0 + 1e-12)))
      refuse({"the reference's ", name, " is ", degrees(angle), " degrees, expected 0 to 90"});
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (!(angles[i - 1] < angles[i]))
      refuse({"the reference's ", name, " of ", degrees(angles[i]), " degrees follows ", degrees(angles[i - 1]),
              ", expected ascending angles"});
}

/// The two neighbouring angles of a table between which an angle lies, and the fraction of the way from the first to
/// the second.
struct angle_interval {
  Eigen::Index first = 0, second = 0;
  double share = 0.0;
};

GONIO_INLINE angle_interval interval_of(const std::vector<double>& angles, double angle, const char* name) {
  constexpr double rounding = radians(1e-6);
  if (angles.empty()) return {};
  if (!(angle >= angles.front() - rounding && angle <= angles.back() + rounding))
    refuse({"the white reference's table covers ", name, " from ", degrees(angles.front()), " to ",
            degrees(angles.back()), " degrees, not ", degrees(angle)});
  if (angles.size() == 1) return {};
  const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, angle);
  const double share = (angle - above[-1]) / (above[0] - above[-1]);
  const Eigen::Index second = above - angles.begin();
  return {second - 1, second, std::clamp(share, 0.0, 1.0)};
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE reference_reflectance::reference_reflectance(double everywhere) : factors_{rgb::Constant(everywhere)} {
  if (!(everywhere > 0.0 && everywhere <= 1.0))
    refuse({"a reference's reflectance must be above 0 and up to 1, not ", everywhere});
}

GONIO_INLINE reference_reflectance::reference_reflectance(std::vector<double> theta_i, std::vector<double> theta_o,
                                                          std::vector<rgb> factors)
    : theta_i_(std::move(theta_i)), theta_o_(std::move(theta_o)), factors_(std::move(factors)) {
  if (theta_i_.empty()) refuse("the reference's table has no theta_i");
  detail::require_ascending(theta_i_, "theta_i");
  detail::require_ascending(theta_o_, "theta_o");
  const std::size_t expected = theta_i_.size() * std::max<std::size_t>(theta_o_.size(), 1);
  if (factors_.size() != expected)
    refuse({"the reference's table has ", factors_.size(), " factors, expected ", expected,
            ", one for each pair of angles"});
  for (const rgb& factor : factors_)
    for (const double each : factor)
      if (!(each > 0.0 && each <= largest_possible))
        refuse({"the reference's table has a factor of ", each, ", expected above 0 and up to ", largest_possible});
}

GONIO_INLINE rgb reference_reflectance::at(const direction_pair& pair) const {
  const auto light = detail::interval_of(theta_i_, polar_angle(pair.wi), "theta_i"),
             viewer = detail::interval_of(theta_o_, polar_angle(pair.wo), "theta_o");
  const auto viewers = std::max<Eigen::Index>(std::ssize(theta_o_), 1);
  const auto seen_under = [&](Eigen::Index row) -> rgb {
    const rgb &first = factors_[row * viewers + viewer.first], &second = factors_[row * viewers + viewer.second];
    return first + viewer.share * (second - first);
  };
  const rgb first = seen_under(light.first), second = seen_under(light.second);
  return first + light.share * (second - first);
}

GONIO_INLINE double reference_reflectance::largest() const {
  double largest = 0.0;
  for (const rgb& factor : factors_) largest = std::max(largest, factor.maxCoeff());
  return largest;
}

}  // namespace gonio::capture
