#pragma once
/// Tests whether an external matrix is a rotation.

#include <Eigen/Core>

namespace gonio {

/// Returns true if a matrix is orthogonal, to 1e-3 (the precision of a file with four decimals), and not a reflection.
[[nodiscard]] bool is_rotation(const Eigen::Matrix3d& matrix);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/rotation.ipp>
#endif
