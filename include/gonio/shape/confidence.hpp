#pragma once
/// How far out a share of a normal distribution reaches, by Eigen's incomplete gamma and beta functions.

#include <gonio/core/error.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/SpecialFunctions>

#include <string>

namespace gonio {

namespace detail {

/// Where an increasing function of a positive number reaches a share, to 1e-12 of that number.
template <class Distribution>
[[nodiscard]] double quantile(double share, Distribution&& cumulative) {
  if (!(share > 0.0 && share < 1.0))
    throw error("a share of a distribution must be above 0 and below 1, not " + std::to_string(share));
  double low = 0.0, high = 1.0;
  while (cumulative(high) < share && high < 1e12) high *= 2.0;
  for (int halvings = 0; halvings < 100 && high - low > 1e-12 * high; ++halvings) {
    const double middle = 0.5 * (low + high);
    (cumulative(middle) < share ? low : high) = middle;
  }
  return high;
}

}  // namespace detail

/// The number that a chi-square variable of so many degrees of freedom, above 0, stays below with a probability.
[[nodiscard]] inline double chi_square_quantile(double share, double degrees_of_freedom) {
  return detail::quantile(share, [=](double x) { return Eigen::numext::igamma(0.5 * degrees_of_freedom, 0.5 * x); });
}

/// The same of an F variable.
[[nodiscard]] double f_quantile(double share, double numerator_degrees, double denominator_degrees);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/confidence.ipp>
#endif
