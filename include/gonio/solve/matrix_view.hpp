#pragma once
/// The parameter type of functions on matrices that are compiled once.

#include <gonio/core/compiled_alignment.hpp>

#include <Eigen/Core>

namespace gonio {

/// A matrix or a block of a matrix, with contiguous columns. Any other expression of doubles is copied into a matrix.
using matrix_view = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

}  // namespace gonio
