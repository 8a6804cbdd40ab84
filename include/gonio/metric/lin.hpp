#pragma once
/// The linear metric: unchanged reflectance. Noell, Koehler and Stricker 2014, section 2.2 and Eq. 16.

#include <gonio/metric/location_free.hpp>

#include <span>

namespace gonio {

/// forward(rho) = rho, also for negative reflectance. Errors of the brightest cells dominate: a highlight a thousand
/// times brighter than the rest decides the fit.
struct lin : location_free_metric<lin> {
  [[nodiscard]] static double map(double rho) noexcept { return rho; }
  [[nodiscard]] static double unmap(double y) noexcept { return y; }
  /// Returns the derivative of `map`.
  [[nodiscard]] static double slope(double /*rho*/) noexcept { return 1.0; }
  static void unmap_all(std::span<float> /*values*/) noexcept {}
};

static_assert(row_metric<lin> && smooth_metric<lin>);

}  // namespace gonio
