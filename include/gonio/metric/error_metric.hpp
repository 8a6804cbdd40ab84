#pragma once
/// The concept of an error metric: a map of reflectance such that squared differences are a meaningful error.

#include <gonio/table/location.hpp>
#include <gonio/table/upsample.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <concepts>
#include <span>

namespace gonio {

/// A strictly increasing map of a reflectance at a cell, or at a location between cells.
///
/// Requirements that the compiler cannot check:
/// - `inverse(forward(rho, where), where) == rho` up to rounding for every finite rho >= 0;
/// - `forward` is also defined and finite for negative rho, and its documentation states how;
/// - a cell number and the location of that cell give the same result;
/// - all members are const, thread safe and do not allocate.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/metric/log.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::log metric;
///   const double mapped = metric.forward(0.3, 0);
///   std::printf("ln(1 + 0.3) = %g, and back: %g\n", mapped, metric.inverse(mapped, 0));
/// }
/// ```
/// With a model of your own, which does not depend on the cell:
/// ```cpp
/// #include <gonio/metric/error_metric.hpp>
///
/// #include <cmath>
/// #include <cstdio>
///
/// struct cube_root {
///   double forward(double rho, const auto&) const noexcept { return std::cbrt(rho); }
///   double inverse(double y, const auto&) const noexcept { return y * y * y; }
/// };
/// static_assert(gonio::error_metric<cube_root>);
///
/// int main() {
///   const Eigen::Index cell = 0;
///   std::printf("%g\n", cube_root{}.forward(0.008, cell));
/// }
/// ```
template <class Metric>
concept error_metric = requires(const Metric& metric, double value, Eigen::Index cell, const location& at) {
  { metric.forward(value, cell) } -> std::convertible_to<double>;
  { metric.inverse(value, cell) } -> std::convertible_to<double>;
  { metric.forward(value, at) } -> std::convertible_to<double>;
  { metric.inverse(value, at) } -> std::convertible_to<double>;
};

/// Returns the reflectance of a mapped value: `inverse`, clamped at zero.
template <error_metric Metric, class Where>
[[nodiscard]] double reflectance_of(const Metric& metric, double mapped, const Where& where) noexcept {
  return std::max(double{metric.inverse(mapped, where)}, 0.0);
}

/// A metric with the derivative of `forward` by the reflectance, `slope(rho)`. The slope is the same at all locations,
/// and finite and positive for every finite rho. Non-linear fits need it.
template <class Metric>
concept smooth_metric = error_metric<Metric> && requires(const Metric& metric, double value) {
  { metric.slope(value) } -> std::convertible_to<double>;
};

/// A metric that maps a whole row of cells back at once, for fast expansion of tables.
///
/// The metric adds `companions` fields of its own, which are interpolated with the three channels. `companion(cell)`
/// returns them as an array of floats; it is not needed if there are none. `mean` states whether `inverse_row` receives
/// the interpolated row or, at the cost of a multiplication, its exponential. `inverse_row(row, values, out)` takes an
/// array with a column for each cell of `row` and 3 + companions rows. It writes `inverse` of the three channels,
/// clamped at zero, to `out`, cell by cell.
template <class Metric>
concept row_metric = error_metric<Metric> &&
    requires(const Metric& metric, const cell_row& row, const cell_fields<3 + Metric::companions>& values,
             std::span<float> out) {
  { Metric::mean } -> std::convertible_to<weighted_mean>;
  metric.inverse_row(row, values, out);
};

}  // namespace gonio
