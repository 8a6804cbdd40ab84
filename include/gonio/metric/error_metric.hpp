#pragma once
/// The concept of an error metric: a map of reflectance under which differences are worth squaring.

#include <gonio/table/location.hpp>
#include <gonio/table/upsample.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <span>

namespace gonio {

/// A strictly increasing map of a reflectance at a cell, or at a location between cells.
///
/// What the compiler cannot check, and a model must keep:
/// - `inverse(forward(rho, where), where) == rho` up to rounding for every finite rho >= 0;
/// - `forward` is defined and finite for negative rho too, and says in its documentation how;
/// - a cell number and the location of that cell give the same result;
/// - all members are const, thread safe and do not allocate.
///
/// A metric that does not depend on the location takes it and ignores it:
/// ```cpp
/// struct identity_metric {
///   double forward(double rho, const auto&) const noexcept { return rho; }
///   double inverse(double y, const auto&) const noexcept { return y; }
/// };
/// static_assert(gonio::error_metric<identity_metric>);
/// ```
template <class Metric>
concept error_metric = requires(const Metric& metric, double value, std::size_t cell, const location& at) {
  { metric.forward(value, cell) } -> std::convertible_to<double>;
  { metric.inverse(value, cell) } -> std::convertible_to<double>;
  { metric.forward(value, at) } -> std::convertible_to<double>;
  { metric.inverse(value, at) } -> std::convertible_to<double>;
};

/// A metric that also knows the derivative of `forward` by the reflectance, `slope(rho)`, wherever that is: finite and
/// positive for every finite rho. Fits that are not linear need it.
template <class Metric>
concept smooth_metric = error_metric<Metric> && requires(const Metric& metric, double value) {
  { metric.slope(value) } -> std::convertible_to<double>;
};

/// A metric that maps a whole row of cells back at once, which is how tables are expanded fast.
///
/// `companions` fields of its own are interpolated beside the three channels, given cell by cell by
/// `companion(cell)` (an array of that many floats; not needed if there are none); `inverse_row(row, values, out)`
/// takes an array of 3 + companions rows and a column for each cell of `row`, which it may destroy, and writes
/// `inverse` of the three channels, clamped at zero, to `out`, cell by cell.
template <class Metric>
concept row_metric = error_metric<Metric> &&
    requires(const Metric& metric, const cell_row& row, cell_fields<3 + Metric::companions>& values,
             std::span<float> out) {
  metric.inverse_row(row, values, out);
};

}  // namespace gonio
