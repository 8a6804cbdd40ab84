#pragma once
/// Bodies of table/sample_set.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace gonio::detail {

/// Throws gonio::error unless a sample is usable. `number` counts from 1, for the message.
GONIO_INLINE void require_usable_sample(const sample& s, Eigen::Index number) {
  const auto refuse = [&](const char* what) { gonio::refuse({"sample ", number, ": ", what}); };
  const auto& [theta_h, theta_d, phi_d] = s.angles();
  if (!std::isfinite(theta_h) || !std::isfinite(theta_d) || !std::isfinite(phi_d)) refuse("an angle is not finite");
  for (Eigen::Index channel = 0; channel < 3; ++channel)
    if (!std::isfinite(s.value[channel])) refuse("a reflectance is not finite");
  for (Eigen::Index channel = 0; channel < 3; ++channel)
    if (std::abs(s.value[channel]) > double{std::numeric_limits<float>::max()})
      refuse("a reflectance is outside the range of float");
  for (Eigen::Index channel = 0; channel < 3; ++channel)
    if (!std::isfinite(s.weight[channel]) || s.weight[channel] < 0.0)
      refuse("the weight must be finite and not negative");
  for (const double half_angle : {s.aperture.source, s.aperture.receiver})
    if (!(half_angle >= 0.0 && half_angle <= largest_half_angle))
      refuse("the half angles of its aperture must be from 0 to 45 degrees");
  const cosine_pair cosine = cosines(s.angles());
  constexpr double right_angle = std::numbers::pi / 2.0;
  const bool in_range = theta_h >= 0.0 && theta_h < right_angle && theta_d >= 0.0 && theta_d < right_angle;
  if (!in_range || !(cosine.i > 0.0 && cosine.o > 0.0))
    gonio::refuse({"sample ", number, ": a direction is at or below the horizon (theta_h ", degrees(theta_h),
                   ", theta_d ", degrees(theta_d), ", phi_d ", degrees(phi_d), " degrees)"});
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE void sample_set::refuse_wavelengths() const {
  refuse({"samples at ", channels_.size(), " wavelengths have no colours: sample_set::colours makes them"});
}

GONIO_INLINE void sample_set::add(const sample_directions& directions, std::span<const double> values,
                                  const channel_weights& weight, const gonio::aperture& aperture) {
  if (std::ssize(values) != channels_.size())
    refuse({"a sample of ", values.size(), " values, expected one for each of ", channels_.size(), " channels"});
  if (channels_.are_wavelengths()) {
    if (!weight.is_uniform()) refuse("samples at wavelengths have one weight, not one for each channel");
    spectra_.insert(spectra_.end(), values.begin(), values.end());
    rows_.push_back({directions, rgb::Zero(), weight, aperture});
  } else {
    rows_.push_back({directions, channels_.colour(values), weight, aperture});
  }
}

GONIO_INLINE sample_set sample_set::subset(std::span<const Eigen::Index> positions) const {
  sample_set some(channels_);
  for (const Eigen::Index i : positions) some.add(directions(i), values(i), weight(i), aperture(i));
  return some;
}

GONIO_INLINE sample_set sample_set::through(const gonio::aperture& aperture) const {
  sample_set others = *this;
  for (sample& each : others.rows_) each.aperture = aperture;
  return others;
}

GONIO_INLINE sample_set sample_set::with_values(gonio::channels kinds,
                                                const std::function<rgb(Eigen::Index)>& value) const {
  sample_set others(std::move(kinds));
  others.rows_ = rows_;
  for (Eigen::Index i = 0; i < std::ssize(rows_); ++i) others.rows_[i].value = value(i);
  return others;
}

GONIO_INLINE sample_set sample_set::channel(Eigen::Index c) const {
  const std::vector<double>& all = channels_.wavelengths();
  gonio::channels one = all.empty() ? gonio::channels::one_value() : gonio::channels({all[c]});
  return with_values(std::move(one), [&](Eigen::Index i) { return rgb(rgb::Constant(values(i)[c])); });
}

GONIO_INLINE sample_set sample_set::under(illuminant light) const {
  sample_set lit = *this;
  lit.channels_ = channels_.under(light);
  return lit;
}

GONIO_INLINE sample_set sample_set::colours() const {
  require_colour(channels_, "a set of samples");
  return with_values({}, [&](Eigen::Index i) { return channels_.colour(values(i)); });
}

GONIO_INLINE sample_set sample_set::in_three_channels() const {
  return with_values({}, [&](Eigen::Index i) { return channels_.three(values(i)); });
}

GONIO_INLINE void require_usable(const sample_set& samples) {
  if (samples.empty()) refuse("there are no samples: at least one is needed");
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    const bool has_colour = !samples.channels().are_wavelengths();
    detail::require_usable_sample({samples.directions(i), has_colour ? samples[i].value : rgb(rgb::Zero()),
                                   samples.weight(i), samples.aperture(i)},
                                  i + 1);
    for (Eigen::Index c = 0; !has_colour && c < samples.channels().size(); ++c)
      if (!std::isfinite(static_cast<float>(samples.values(i)[c])))
        refuse({"sample ", i + 1, ": the reflectance at wavelength ", c + 1,
                " is not finite or outside the range of float"});
  }
}

GONIO_INLINE std::vector<Eigen::Index> counting_positions(const sample_set& samples) {
  std::vector<Eigen::Index> positions;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i)
    if (samples.weight(i).counts()) positions.push_back(i);
  return positions;
}

}  // namespace gonio
