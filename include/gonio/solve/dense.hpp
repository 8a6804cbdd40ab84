#pragma once
/// Dense algebra in double precision, through few instantiations of Eigen's templates.
///
/// Each kind of product or factorisation that a file names costs its compiler up to two seconds, since Eigen generates
/// its kernels for every combination of types. Whoever needs one calls these functions instead: all of them take
/// matrices stored by columns, and `gonio::compiled` has them compiled already. An expression that is no matrix with
/// contiguous columns, such as a transpose, is copied into one: O(m n) beside the O(m n k) of the product.

#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/solve/thin_product.hpp>
