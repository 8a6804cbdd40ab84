#pragma once
/// The two loops that dense algebra is made of, on contiguous numbers, compiled once: whoever writes them as
/// expressions pays for each combination of matrices, columns and parts of columns that occurs.

#include <Eigen/Core>

namespace gonio {

/// The sum of a[i] b[i].
[[nodiscard]] double dot(const double* a, const double* b, Eigen::Index count);
[[nodiscard]] float dot(const float* a, const float* b, Eigen::Index count);

/// Adds factor a[i] to sum[i].
void add_scaled(double factor, const double* a, double* sum, Eigen::Index count);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/vector_kernels.ipp>
#endif
