#pragma once
/// Facts about measurements, without a fit.

#include "tool/files/json.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/table/sample_set.hpp>

#include <span>

namespace cli {

/// Returns an angle in degrees, to a thousandth.
[[nodiscard]] double rounded_degrees(double radians);

/// Returns all angles of a measurement, rounded like this: theta_i, phi_i, theta_o, phi_o, theta_h, theta_d, phi_d.
[[nodiscard]] json angles_as_json(const gonio::sample_directions& directions);

/// Returns the number of samples, the ranges of their angles (degrees), values and weights, the number of repeats of
/// earlier half and difference angles, and sentences on suspicious properties.
[[nodiscard]] json facts_of(const gonio::sample_set& samples);

/// The same for directions only.
[[nodiscard]] json facts_of(std::span<const gonio::direction_pair> pairs);

}  // namespace cli
