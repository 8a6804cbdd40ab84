#pragma once
/// Facts about measurements, without a fit.

#include "tool/files/json.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/table/sample_set.hpp>

#include <span>

namespace cli {

/// Returns an angle in degrees, to a thousandth.
[[nodiscard]] double rounded_degrees(double radians);

/// Returns theta_i, phi_i, theta_o, phi_o, theta_h, theta_d and phi_d of a measurement as `rounded_degrees`.
[[nodiscard]] json angles_as_json(const gonio::sample_directions& directions);

/// Returns the number of samples, the ranges of their angles (degrees), values and weights, the number of repeats of
/// earlier half and difference angles, and sentences on suspicious properties.
[[nodiscard]] json facts_of(const gonio::sample_set& samples);

/// Returns these facts for directions, without values and weights.
[[nodiscard]] json facts_of(std::span<const gonio::direction_pair> pairs);

}  // namespace cli
