#pragma once
/// Bodies of shape/confidence.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/confidence.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/SpecialFunctions>

namespace gonio::shape::detail {

/// Where an increasing function of a positive number reaches a share, to 1e-12 of that number.
template <class Distribution>
[[nodiscard]] double quantile(double share, Distribution&& cumulative) {
  if (!(share > 0.0 && share < 1.0)) refuse({"a share of a distribution must be above 0 and below 1, not ", share});
  double low = 0.0, high = 1.0;
  while (cumulative(high) < share && high < 1e12) high *= 2.0;
  for (int halvings = 0; halvings < 100 && high - low > 1e-12 * high; ++halvings) {
    const double middle = 0.5 * (low + high);
    (cumulative(middle) < share ? low : high) = middle;
  }
  return high;
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE double chi_square_quantile(double share, double degrees_of_freedom) {
  return detail::quantile(share, [=](double x) { return Eigen::numext::igamma(0.5 * degrees_of_freedom, 0.5 * x); });
}

GONIO_INLINE double f_quantile(double share, double numerator_degrees, double denominator_degrees) {
  return detail::quantile(share, [=](double x) {
    const double part = numerator_degrees * x;
    return Eigen::numext::betainc(0.5 * numerator_degrees, 0.5 * denominator_degrees,
                                  part / (part + denominator_degrees));
  });
}

}  // namespace gonio::shape
