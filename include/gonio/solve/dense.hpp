#pragma once
/// Dense algebra in double precision, with few instantiations of Eigen's templates.
///
/// Each kind of product or factorisation in a file costs up to two seconds of compilation, because Eigen generates its
/// kernels for every combination of types. Call these functions instead. All take matrices stored by columns, and are
/// compiled once in `gonio::compiled`. An expression that is not a matrix with contiguous columns, such as a transpose,
/// is first copied into such a matrix: O(m n), compared with O(m n k) for the product.

#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/solve/thin_product.hpp>
