#pragma once
/// How far out a share of a normal distribution reaches, by Eigen's incomplete gamma and beta functions.

namespace gonio::shape {

/// The number that a chi-square variable of so many degrees of freedom, above 0, stays below with a probability.
[[nodiscard]] double chi_square_quantile(double share, double degrees_of_freedom);

/// The same of an F variable.
[[nodiscard]] double f_quantile(double share, double numerator_degrees, double denominator_degrees);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/confidence.ipp>
#endif
