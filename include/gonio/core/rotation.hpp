#pragma once
/// Whether a matrix that comes from outside is a rotation.

#include <Eigen/Core>

namespace gonio {

/// Is a matrix orthogonal, to 1e-3 (what a file with four decimals has), and no mirror image?
[[nodiscard]] bool is_rotation(const Eigen::Matrix3d& matrix);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/rotation.ipp>
#endif
