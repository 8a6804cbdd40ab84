#pragma once
/// Bodies of core/probability.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/probability.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/SpecialFunctions>

#include <cmath>

namespace gonio::detail {

/// Returns the positive number at which an increasing function reaches a share, to a relative error of 1e-12.
template <class Distribution>
[[nodiscard]] double positive_quantile(double share, Distribution&& cumulative) {
  if (!(share > 0.0 && share < 1.0)) refuse({"a probability must be above 0 and below 1, not ", share});
  double low = 0.0, high = 1.0;
  while (cumulative(high) < share && high < 1e12) high *= 2.0;
  for (int halvings = 0; halvings < 100 && high - low > 1e-12 * high; ++halvings) {
    const double middle = 0.5 * (low + high);
    (cumulative(middle) < share ? low : high) = middle;
  }
  return high;
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE double chi_square_quantile(double share, double degrees_of_freedom) {
  return detail::positive_quantile(share,
                                   [=](double x) { return Eigen::numext::igamma(0.5 * degrees_of_freedom, 0.5 * x); });
}

GONIO_INLINE double f_quantile(double share, double numerator_degrees, double denominator_degrees) {
  return detail::positive_quantile(share, [=](double x) {
    const double part = numerator_degrees * x;
    return Eigen::numext::betainc(0.5 * numerator_degrees, 0.5 * denominator_degrees,
                                  part / (part + denominator_degrees));
  });
}

GONIO_INLINE double chi_square_tail(double value, double degrees_of_freedom) {
  return value > 0.0 ? Eigen::numext::igammac(0.5 * degrees_of_freedom, 0.5 * value) : 1.0;
}

GONIO_INLINE double f_tail(double value, double numerator_degrees, double denominator_degrees) {
  if (!(value > 0.0)) return 1.0;
  if (std::isinf(denominator_degrees)) return chi_square_tail(numerator_degrees * value, numerator_degrees);
  const double part = numerator_degrees * value;
  return Eigen::numext::betainc(0.5 * denominator_degrees, 0.5 * numerator_degrees,
                                denominator_degrees / (part + denominator_degrees));
}

}  // namespace gonio
