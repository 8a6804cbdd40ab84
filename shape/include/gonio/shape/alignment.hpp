#pragma once
/// Shapes brought onto one another by rotation, translation and, if wanted, scale: one onto one in the least-squares
/// sense (Umeyama, IEEE PAMI 13(4), 1991, doi:10.1109/34.88573; Kabsch, Acta Cryst. A32, 1976,
/// doi:10.1107/S0567739476001873), and many onto their mean by generalised Procrustes alignment (Gower, Psychometrika
/// 40, 1975, doi:10.1007/BF02291478). As "Anatomically correct surface recovery" does (Nielsen's doctoral thesis, DTU
/// 2016, contribution C.V, section 2 and Algorithm 1).

#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio::shape {

/// x -> scale * rotation * x + translation.
struct similarity_transform {
  double scale = 1.0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  /// Of one point or of many, one for each column.
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

  /// The one on the right first, as with matrices.
  [[nodiscard]] friend similarity_transform operator*(const similarity_transform& second,
                                                      const similarity_transform& first) {
    return second.after(first);
  }

 private:
  [[nodiscard]] Eigen::Vector3d moved_point(const Eigen::Vector3d& point) const;
  [[nodiscard]] point_columns moved_points(const point_columns& points) const;
  [[nodiscard]] similarity_transform after(const similarity_transform& first) const;
};

/// What an alignment may change besides the translation.
enum class alignment_kind {
  rigid,      ///< the rotation
  similarity  ///< the rotation and the scale
};

/// The transform T that minimises sum_i weights_i |T(from_i) - onto_i|^2 over corresponded points; a mirror image is
/// never made. Without weights all points count the same. O(points).
///
/// Throws gonio::error if the numbers of points or weights differ, anything is not finite, a weight is negative, fewer
/// than three points have weight, or the points leave the rotation undetermined: those on one side all lie on a line,
/// or onto is so close to a mirror image that two rotations are equally good. Eigen::umeyama, which has no weights,
/// says nothing in these cases.
[[nodiscard]] similarity_transform align(const point_columns& from, const point_columns& onto,
                                         alignment_kind kind = alignment_kind::rigid,
                                         const Eigen::VectorXd& weights = {});

/// Corresponded shapes in common coordinates.
struct aligned_shapes {
  std::vector<point_columns> shapes;  ///< in the order they were given
  point_columns mean;
  int iterations = 0;  ///< until the mean stood still
};

/// When `procrustes_mean` ends.
struct procrustes_options {
  alignment_kind kind = alignment_kind::rigid;
  double tolerance = 1e-9;  ///< the change of the mean, relative to its centroid size
  int most_iterations = 1000;
};

namespace detail {

/// Root of the summed squares of the distances from the centroid.
[[nodiscard]] double centroid_size(const point_columns& points);

}  // namespace detail

/// Aligns each shape with the mean of all, over and over until the mean stands still. The first mean is the first
/// shape, in whose coordinates the result is. With similarities, which alone would shrink all shapes to a point, the
/// mean keeps the mean centroid size of the given shapes, so that lengths keep their unit; with rigid transforms it is
/// the plain mean of the aligned shapes. O(points x shapes) for an iteration.
///
/// Throws gonio::error where `align` does, if there is no shape or their sizes differ, and if the mean still changes
/// after the last iteration.
[[nodiscard]] aligned_shapes procrustes_mean(const std::vector<point_columns>& shapes,
                                             const procrustes_options& options = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/alignment.ipp>
#endif
