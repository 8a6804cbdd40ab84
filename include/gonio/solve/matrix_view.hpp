#pragma once
/// How matrices are handed to functions that are compiled once.

#include <gonio/core/compiled_alignment.hpp>

#include <Eigen/Core>

namespace gonio {

/// A matrix or a block of one, its columns contiguous; anything else of doubles is copied into one.
using matrix_view = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

}  // namespace gonio
