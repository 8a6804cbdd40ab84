#pragma once
/// Quantiles and upper tails of the chi-square and the F distribution, by Eigen's incomplete gamma and beta functions.

namespace gonio {

/// Returns the quantile of a chi-square variable with positive degrees of freedom.
[[nodiscard]] double chi_square_quantile(double share, double degrees_of_freedom);

/// Returns the quantile of an F variable.
[[nodiscard]] double f_quantile(double share, double numerator_degrees, double denominator_degrees);

/// Returns the probability that a chi-square variable exceeds a value, to a relative error of about 1e-10 even for tiny
/// probabilities; 1 for a value of 0 or less.
[[nodiscard]] double chi_square_tail(double value, double degrees_of_freedom);

/// Returns the probability that an F variable exceeds a value. With infinite denominator degrees, the F variable is a
/// chi-square variable divided by its degrees of freedom.
[[nodiscard]] double f_tail(double value, double numerator_degrees, double denominator_degrees);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/probability.ipp>
#endif
