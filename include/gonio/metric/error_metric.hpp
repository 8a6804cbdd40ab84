#pragma once
/// The concept of an error metric: a map of reflectance under which differences are worth squaring.

#include <gonio/table/location.hpp>

#include <concepts>
#include <cstddef>

namespace gonio {

/// A strictly increasing map of a reflectance at a cell, or at a location between cells.
///
/// What the compiler cannot check, and a model must keep:
/// - `inverse(forward(rho, where), where) == rho` up to rounding for every finite rho >= 0;
/// - `forward` is defined and finite for negative rho too, and says in its documentation how;
/// - a cell number and the location of that cell give the same result;
/// - all members are const, thread safe and do not allocate.
///
/// A metric that does not depend on the place takes it and ignores it:
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

}  // namespace gonio
