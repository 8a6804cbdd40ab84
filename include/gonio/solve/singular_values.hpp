#pragma once
/// Singular values in double precision, compiled once (see dense.hpp). Golub and Van Loan, Matrix Computations, 4th ed.
/// 2013, 5.4.8 (bidiagonalisation) and 8.6.1 (the symmetric tridiagonal matrix with the same values). Eigen's JacobiSVD
/// costs whoever includes it 5 seconds, its BDCSVD 19.

#include <gonio/solve/matrix_view.hpp>

namespace gonio {

/// The min(n, k) singular values of an n x k matrix, ascending, each to some roundings of the largest one: squares, as
/// a Gram matrix has, would lose those below 1e-8 of it. 2 n k^2 + 8/3 k^3 operations for n >= k. Throws gonio::error,
/// naming `what` was decomposed, if an entry is not finite.
[[nodiscard]] Eigen::VectorXd singular_values(const matrix_view& a, const char* what);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/singular_values.ipp>
#endif
