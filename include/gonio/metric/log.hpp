#pragma once
/// The logarithmic metric ln(1 + rho). Noell, Koehler and Stricker 2014, section 2.4 and Eq. 14.

#include <gonio/metric/place_free.hpp>

#include <cmath>

namespace gonio {

/// forward(rho) = ln(1 + rho), continued to negative reflectance as an odd function, -ln(1 - rho): smooth at zero,
/// where it is linear, and finite for every measurement.
struct log : place_free_metric<log> {
  [[nodiscard]] static double map(double rho) noexcept { return std::copysign(std::log1p(std::abs(rho)), rho); }
  [[nodiscard]] static double unmap(double y) noexcept { return std::copysign(std::expm1(std::abs(y)), y); }
  template <class Values>
  static void unmap_all(Values& values) {
    values = values.max(0.0f).expm1();
  }
};

static_assert(row_metric<log>);

}  // namespace gonio
