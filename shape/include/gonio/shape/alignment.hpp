#pragma once
/// Alignment of shapes by rotation, translation and optionally scale. `align` aligns two shapes by least squares
/// (Umeyama, IEEE PAMI 13(4), 1991, doi:10.1109/34.88573; Kabsch, Acta Cryst. A32, 1976,
/// doi:10.1107/S0567739476001873). `procrustes_mean` aligns many to their mean by generalised Procrustes alignment
/// (Gower, Psychometrika 40, 1975, doi:10.1007/BF02291478), as in "Anatomically correct surface recovery" (Nielsen's
/// doctoral thesis, DTU 2016, contribution C.V, section 2 and Algorithm 1).

#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio::shape {

/// x -> scale * rotation * x + translation.
struct similarity_transform {
  double scale = 1.0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  /// Transforms one point, or many in columns.
  template <class Derived>
  [[nodiscard]] Eigen::Matrix<double, 3, Derived::ColsAtCompileTime> operator()(
      const Eigen::MatrixBase<Derived>& points) const {
    static_assert(Derived::RowsAtCompileTime == 3);
    if constexpr (Derived::ColsAtCompileTime == 1)
      return moved_point(points);
    else
      return moved_points(points);
  }

  [[nodiscard]] similarity_transform inverse() const;

  /// Applies the right transform first, as with matrices.
  [[nodiscard]] friend similarity_transform operator*(const similarity_transform& second,
                                                      const similarity_transform& first) {
    return second.after(first);
  }

 private:
  [[nodiscard]] Eigen::Vector3d moved_point(const Eigen::Vector3d& point) const;
  [[nodiscard]] point_columns moved_points(const point_columns& points) const;
  [[nodiscard]] similarity_transform after(const similarity_transform& first) const;
};

/// The freedom of an alignment, besides translation.
enum class alignment_kind {
  rigid,      ///< rotation
  similarity  ///< rotation and scale
};

/// Returns the transform T, without reflection, that minimises sum_i weights_i |T(from_i) - onto_i|^2 over
/// corresponding points. Without weights, all points count equally. O(points).
///
/// Throws gonio::error if the numbers of points or weights differ, a value is not finite, a weight is negative, fewer
/// than three points have positive weight, or the rotation is undetermined: the points of one shape lie on a line, or
/// `onto` is so close to a mirror image of `from` that two rotations fit equally well. Eigen::umeyama has no weights
/// and does not report these cases.
[[nodiscard]] similarity_transform align(const point_columns& from, const point_columns& onto,
                                         alignment_kind kind = alignment_kind::rigid,
                                         const Eigen::VectorXd& weights = {});

/// Corresponded shapes in common coordinates.
struct aligned_shapes {
  std::vector<point_columns> shapes;  ///< in the order they were given
  point_columns mean;
  int iterations = 0;  ///< until the mean converged
};

/// The stopping rule of `procrustes_mean`.
struct procrustes_options {
  alignment_kind kind = alignment_kind::rigid;
  double tolerance = 1e-9;  ///< largest change of the mean, relative to the shapes' mean centroid size
  int most_iterations = 1000;
};

namespace detail {

/// Returns the square root of the sum of squared distances from the centroid.
[[nodiscard]] double centroid_size(const point_columns& points);

}  // namespace detail

/// Repeatedly aligns each shape to the mean of all, until the mean converges. The first mean is the first shape, and
/// the result stays in its coordinates. With rigid transforms, `mean` is the mean of the aligned shapes. With
/// similarities, each iteration scales the mean to the mean centroid size of the given shapes; without that, all shapes
/// would shrink to a point. O(points x shapes) per iteration.
///
/// Throws gonio::error as `align` does, and if there is no shape, if the numbers of points differ, or if the mean still
/// changes after the last iteration.
[[nodiscard]] aligned_shapes procrustes_mean(const std::vector<point_columns>& shapes,
                                             const procrustes_options& options = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/alignment.ipp>
#endif
