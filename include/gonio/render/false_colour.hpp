#pragma once
/// A number as a colour, from blue over green to red, for images of differences. Noell, Koehler and Stricker 2014,
/// Fig. 3: CIELAB differences "from blue (0.0), over green to red (20.0 and higher)".

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

}  // namespace gonio::render
