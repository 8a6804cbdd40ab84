#pragma once
/// What the tests of the simulated laboratories have in common: a material and pairs of directions.

#include <lab/measure.hpp>

#include <random>
#include <vector>

/// A coloured Lambertian with a glossy lobe.
inline gonio::rgb glossy(const gonio::direction& wi, const gonio::direction& wo) {
  if (!(wi.z() > 0.0 && wo.z() > 0.0)) return gonio::rgb::Zero();
  const double shine = 2.0 * std::pow((wi + wo).normalized().z(), 40.0);
  return gonio::rgb(0.2, 0.05, 0.01) + shine;
}

/// Pairs above the horizon by some degrees, lights at multiples of a step, if there is one.
inline std::vector<gonio::direction_pair> scattered_pairs(std::size_t count, unsigned seed, double light_step = 0.0) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> polar(0.0, gonio::radians(80.0)), azimuth(0.0, 2.0 * std::numbers::pi);
  std::vector<gonio::direction_pair> pairs;
  while (pairs.size() < count) {
    double theta_i = polar(generator);
    if (light_step > 0.0) theta_i = light_step * std::round(theta_i / light_step);
    const double phi_i = azimuth(generator), theta_o = polar(generator), phi_o = azimuth(generator);
    pairs.push_back({gonio::spherical_direction(theta_i, phi_i), gonio::spherical_direction(theta_o, phi_o)});
  }
  return pairs;
}
