#pragma once
/// Colours for numbers, suitable for all kinds of colour vision: light to dark for errors, uncertainties and shares;
/// blue, white and red for signed values; distinct colours for categories.

#include <gonio/core/assertion.hpp>
#include <gonio/core/rgb.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace gonio::render {

/// Returns the linear colour of a signed value: white at zero, red from `limit` on, blue from -limit down, mixed in
/// linear light. From -limit to limit, red - blue is value / limit. Values must not be NaN.
[[nodiscard]] inline rgb diverging_colour(double value, double limit) noexcept {
  GONIO_ASSERT(limit > 0.0);
  GONIO_ASSERT(value == value);
  const double share = std::clamp(value / limit, -1.0, 1.0);
  return {1.0 + std::min(share, 0.0), 1.0 - std::abs(share), 1.0 - std::max(share, 0.0)};
}

/// Returns the linear colour of a share from 0 (light) to 1 (dark blue); other shares are clipped. Lightness decreases
/// evenly, so the order is visible to all kinds of colour vision. Black is reserved for missing values. Shares must not
/// be NaN.
[[nodiscard]] inline rgb sequential_colour(double share) noexcept {
  GONIO_ASSERT(share == share);
  // Five colours from #f3ecd2 to #123a63 in linear light, mixed in equal steps of display values, as in
  // examples/report.
  constexpr std::array<std::array<double, 3>, 5> quarters{{{0.8963, 0.8388, 0.6445},
                                                           {0.4955, 0.5241, 0.4692},
                                                           {0.2251, 0.2918, 0.3255},
                                                           {0.0689, 0.1342, 0.2113},
                                                           {0.0060, 0.0423, 0.1248}}};
  const double position = 4.0 * std::clamp(share, 0.0, 1.0);
  const auto below = std::min(static_cast<std::size_t>(position), std::size_t{3});
  const double above = position - static_cast<double>(below);
  const auto &low = quarters[below], &high = quarters[below + 1];
  return {(1.0 - above) * low[0] + above * high[0], (1.0 - above) * low[1] + above * high[1],
          (1.0 - above) * low[2] + above * high[2]};
}

/// Returns the linear colour of a CIELAB difference: light for zero, dark for `largest` and more. The default of
/// `largest` is from Noell, Koehler and Stricker 2014, Fig. 3. Their colours go from blue through green to red, an
/// order that is not visible without a scale.
[[nodiscard]] inline rgb difference_colour(double delta_e, double largest = 20.0) noexcept {
  GONIO_ASSERT(largest > 0.0);
  return sequential_colour(delta_e / largest);
}

/// Returns the position of a value on a logarithmic scale: 0 for values up to `lowest`, 1 for `highest`, above 1 for
/// larger values. `lowest` must be positive.
[[nodiscard]] inline double logarithmic_position(double value, double lowest, double highest) noexcept {
  return std::log(std::max(value, lowest) / lowest) / std::log(highest / lowest);
}

/// Returns the linear colour of a relative uncertainty: light up to 2 %, dark from 100 % on.
[[nodiscard]] inline rgb uncertainty_colour(double uncertainty) noexcept {
  return sequential_colour(logarithmic_position(uncertainty, 0.02, 1.0));
}

/// The number of categories that have colours.
inline constexpr int categories = 8;

/// Returns the linear colour of one of 8 categories: the colours of Okabe and Ito (Color Universal Design, 2002), with
/// light grey instead of black. Black is reserved for points without a category.
[[nodiscard]] inline rgb category_colour(int category) noexcept {
  GONIO_ASSERT(category >= 0 && category < categories);
  constexpr std::array<std::array<double, 3>, categories> colours{{{0.791, 0.347, 0.0},
                                                                   {0.093, 0.456, 0.815},
                                                                   {0.0, 0.342, 0.171},
                                                                   {0.871, 0.776, 0.054},
                                                                   {0.0, 0.168, 0.445},
                                                                   {0.665, 0.112, 0.0},
                                                                   {0.604, 0.191, 0.386},
                                                                   {0.6, 0.6, 0.6}}};
  const auto& own = colours[static_cast<std::size_t>(category)];
  return {own[0], own[1], own[2]};
}

}  // namespace gonio::render
