#pragma once
/// A basis of shapes that may also move: the shapes' functions and six of rigid motion side by side, so that one fit
/// finds shape and pose together.

#include <gonio/basis/basis.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/shape_basis.hpp>

#include <Eigen/Core>

#include <span>

namespace gonio::shape {

/// The functions of a shape basis, then what a small turn about each axis through the centroid of `moved` and a shift
/// along each does to that shape.
///
/// What is moved is a shape of the family, not its mean: a turn of the mean differs from one of the shape by a change
/// of shape, and a fit that may turn the mean only ends where the shape would still turn. Copies share the functions.
class shape_with_motion {
 public:
  /// Three turns and three shifts.
  static constexpr Eigen::Index motions = 6;

  /// The weights of the motions are the turn in radians and the shift in the unit of the mesh, each divided by
  /// `freedom`: the larger it is, the less a solver's penalty holds the shape in place. Throws gonio::error for a shape
  /// of another number of vertices.
  shape_with_motion(shape_basis shape, const point_columns& moved, double freedom = 1e3);

  [[nodiscard]] Eigen::Index size() const noexcept { return shape_.size() + Eigen::Index{motions}; }
  [[nodiscard]] const vertex_coordinates& cells() const noexcept { return shape_.cells(); }
  [[nodiscard]] std::span<const float> row(Eigen::Index coordinate) const {
    return std::span(&functions_(coordinate, 0), size());
  }
  [[nodiscard]] double offset(Eigen::Index coordinate) const { return shape_.offset(coordinate); }
  [[nodiscard]] const lin& metric() const noexcept { return shape_.metric(); }

  /// The basis of shapes alone.
  [[nodiscard]] const shape_basis& shape() const noexcept { return shape_; }
  /// All functions: coordinates x size().
  [[nodiscard]] const cell_matrix& functions() const noexcept { return functions_; }

  /// What weights stand for.
  struct parts {
    Eigen::VectorXd shape;        ///< the weights of `shape()`
    similarity_transform motion;  ///< of that shape
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
