#pragma once
/// What can be said of measurements before anything is fitted to them.

#include "tool/files/json.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/table/sample_set.hpp>

#include <span>

namespace cli {

/// An angle in degrees, to a thousandth.
[[nodiscard]] double rounded_degrees(double radians);

/// All angles of a measurement, each rounded so: theta_i, phi_i, theta_o, phi_o, theta_h, theta_d, phi_d.
[[nodiscard]] json angles_as_json(const gonio::sample_directions& directions);

/// How many there are, the ranges of their angles (degrees), values and weights, how many repeat the half and
/// difference angles of one before, and sentences on what is suspicious.
[[nodiscard]] json facts_of(const gonio::sample_set& samples);

/// The same of directions alone.
[[nodiscard]] json facts_of(std::span<const gonio::direction_pair> pairs);

}  // namespace cli
