#pragma once
/// Numbers as colours. From blue over green to red, for images of how large a difference is: Noell, Koehler and
/// Stricker 2014, Fig. 3, CIELAB differences "from blue (0.0), over green to red (20.0 and higher)". From blue over
/// white to red, for what has a sign.

#include <gonio/core/assertion.hpp>
#include <gonio/core/rgb.hpp>

#include <algorithm>
#include <cmath>

namespace gonio::render {

/// The values that show as pure blue and pure red; the default is the paper's. Their mean shows as pure green.
struct false_colour_range {
  double blue = 0.0;
  double red = 20.0;
};

/// The linear colour of a value: blue up to `range.blue`, red from `range.red` on, through green, two neighbours
/// mixed in proportion. The paper does not say how its colours are mixed; here it is in linear light, so that for any
/// value in the range red - blue is twice its place in the range minus 1. NaN is not a value.
[[nodiscard]] inline rgb false_colour(double value, const false_colour_range& range = {}) noexcept {
  GONIO_ASSERT(range.blue < range.red);
  GONIO_ASSERT(value == value);
  // -1 is blue, 0 green, 1 red.
  const double place = std::clamp(2.0 * (value - range.blue) / (range.red - range.blue) - 1.0, -1.0, 1.0);
  return {std::max(place, 0.0), 1.0 - std::abs(place), std::max(-place, 0.0)};
}

/// The linear colour of a value with a sign: white at zero, red from `limit` on, blue up to minus that, mixed in linear
/// light between them, so that for any value from -limit to limit red - blue is value / limit. NaN is not a value.
[[nodiscard]] inline rgb diverging_colour(double value, double limit) noexcept {
  GONIO_ASSERT(limit > 0.0);
  GONIO_ASSERT(value == value);
  const double share = std::clamp(value / limit, -1.0, 1.0);
  return {1.0 + std::min(share, 0.0), 1.0 - std::abs(share), 1.0 - std::max(share, 0.0)};
}

}  // namespace gonio::render
