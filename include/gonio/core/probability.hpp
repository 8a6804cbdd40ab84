#pragma once
/// Quantiles and upper tails of the chi-square and the F distribution, by Eigen's incomplete gamma and beta functions.

namespace gonio {

/// The number that a chi-square variable of so many degrees of freedom, above 0, stays below with a probability.
[[nodiscard]] double chi_square_quantile(double share, double degrees_of_freedom);

/// The same of an F variable.
[[nodiscard]] double f_quantile(double share, double numerator_degrees, double denominator_degrees);

/// The probability that a chi-square variable exceeds a value, to a relative 1e-10 or so even where it is tiny; 1 for a
/// value of 0 or less.
[[nodiscard]] double chi_square_tail(double value, double degrees_of_freedom);

/// The same of an F variable; infinite denominator degrees make it that of a chi-square variable over its degrees.
[[nodiscard]] double f_tail(double value, double numerator_degrees, double denominator_degrees);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/probability.ipp>
#endif
