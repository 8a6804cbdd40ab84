#pragma once
/// A shape basis with six more functions for rigid motion: one fit finds shape and pose.

#include <gonio/basis/basis.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/shape_basis.hpp>

#include <Eigen/Core>

#include <span>

namespace gonio::shape {

/// The functions of a shape basis, followed by the displacements of the shape `moved` by small rotations about each
/// axis through its centroid and by shifts along each axis.
///
/// `moved` is the current shape: with the mean, a fit would stop while the shape still needs to rotate.
class shape_with_motion {
 public:
  /// Three rotations and three shifts.
  static constexpr Eigen::Index motions = 6;

  /// The weights of the motions are the rotation in radians and the shift in the unit of the mesh, each divided by
  /// `freedom`. The larger `freedom` is, the less a solver's penalty restrains the motion. Throws gonio::error if
  /// `moved` does not have as many vertices as `shape`.
  shape_with_motion(shape_basis shape, const point_columns& moved, double freedom = 1e3);

  [[nodiscard]] Eigen::Index size() const noexcept { return shape_.size() + Eigen::Index{motions}; }
  [[nodiscard]] const vertex_coordinates& cells() const noexcept { return shape_.cells(); }
  [[nodiscard]] std::span<const float> row(Eigen::Index coordinate) const {
    return std::span(&functions_(coordinate, 0), size());
  }
  [[nodiscard]] double offset(Eigen::Index coordinate) const { return shape_.offset(coordinate); }
  [[nodiscard]] const lin& metric() const noexcept { return shape_.metric(); }

  [[nodiscard]] const shape_basis& shape() const noexcept { return shape_; }
  /// Returns all functions: coordinates x size().
  [[nodiscard]] const cell_matrix& functions() const noexcept { return functions_; }

  /// The shape and motion that weights represent.
  struct parts {
    Eigen::VectorXd shape;        ///< the weights of `shape()`
    similarity_transform motion;  ///< of the shape that `shape` represents
  };
  [[nodiscard]] parts split(const Eigen::VectorXd& weights) const;

 private:
  shape_basis shape_;
  cell_matrix functions_;
  Eigen::Vector3d centroid_;  ///< of the shape that moves
  double freedom_;
};

static_assert(tabulated_basis<shape_with_motion>);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/shape_with_motion.ipp>
#endif
