#pragma once
/// The linear metric: reflectance as it is. Noell, Koehler and Stricker 2014, section 2.2 and Eq. 16.

#include <gonio/metric/place_free.hpp>

#include <span>

namespace gonio {

/// forward(rho) = rho, for negative reflectance too. Its errors are those of the brightest cells: a highlight a
/// thousand times the rest decides the fit.
struct lin : place_free_metric<lin> {
  [[nodiscard]] static double map(double rho) noexcept { return rho; }
  [[nodiscard]] static double unmap(double y) noexcept { return y; }
  /// The derivative of `map`.
  [[nodiscard]] static double slope(double /*rho*/) noexcept { return 1.0; }
  static void unmap_all(std::span<float> /*values*/) noexcept {}
};

static_assert(row_metric<lin> && smooth_metric<lin>);

}  // namespace gonio
