#pragma once
/// Parts that match their reference, in channels other than red, green and blue.

#include <gonio/conformity/conformity.hpp>
#include <gonio/core/random.hpp>

#include <array>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace papers {

/// Colours, and channels computed from them: one value, one wavelength, and five mixtures.
[[nodiscard]] inline std::vector<std::pair<std::string, gonio::channels>> compared_channels() {
  return {{"red, green, blue", {}},
          {"one value", gonio::channels::one_value()},
          {"550 nm", gonio::channels({550.0})},
          {"five wavelengths", gonio::channels({450.0, 500.0, 550.0, 600.0, 650.0})}};
}

/// Three angles of incidence, with the receiver in the plane of incidence in steps of 15 degrees.
[[nodiscard]] inline std::vector<gonio::half_difference> directions_in_plane() {
  std::vector<gonio::half_difference> all;
  for (const double theta_i : {20.0, 45.0, 60.0})
    for (int theta_o = -75; theta_o <= 75; theta_o += 15) {
      const auto light = gonio::spherical_direction(gonio::radians(theta_i), 0.0);
      const auto receiver =
          gonio::spherical_direction(gonio::radians(std::abs(theta_o)), theta_o < 0 ? std::numbers::pi : 0.0);
      all.push_back(gonio::to_half_difference(light, receiver));
    }
  return all;
}

/// Measures a surface in some channels, with independent noise on each value.
[[nodiscard]] inline gonio::sample_set measure_channels(
    const std::function<gonio::rgb(const gonio::direction_pair&)>& surface, const gonio::channels& kinds,
    const std::vector<gonio::half_difference>& where, double noise, std::uint64_t seed) {
  constexpr std::array<std::array<double, 3>, 5> mixtures{
      {{0.1, 0.1, 0.8}, {0.0, 0.5, 0.5}, {0.0, 1.0, 0.0}, {0.5, 0.5, 0.0}, {0.9, 0.1, 0.0}}};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  gonio::sample_set samples(kinds);
  for (const gonio::half_difference& at : where) {
    const gonio::rgb colour = surface(gonio::to_directions(at));
    std::vector<double> values{colour[0], colour[1], colour[2]};
    if (kinds.size() == 1) values = {colour[1]};
    if (kinds.size() == 5) {
      values.clear();
      for (const auto& mixture : mixtures)
        values.push_back(mixture[0] * colour[0] + mixture[1] * colour[1] + mixture[2] * colour[2]);
    }
    for (double& each : values) each *= 1.0 + noise * normal(random);
    samples.add(at, values);
  }
  return samples;
}

}  // namespace papers
