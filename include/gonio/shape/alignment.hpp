#pragma once
/// Shapes brought onto one another by rotation, translation and, if wanted, scale: one onto one in the least-squares
/// sense (Umeyama, IEEE PAMI 13(4), 1991; Kabsch, Acta Cryst. A32, 1976), and many onto their mean by generalised
/// Procrustes alignment (Gower, Psychometrika 40, 1975). As "Anatomically correct surface recovery" does (Nielsen's
/// doctoral thesis, DTU 2016, contribution C.V, section 2 and Algorithm 1).

#include <gonio/core/error.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/SVD>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

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
    Eigen::Matrix<double, 3, Derived::ColsAtCompileTime> moved = scale * rotation * points;
    moved.colwise() += translation;
    return moved;
  }

  [[nodiscard]] similarity_transform inverse() const {
    const Eigen::Matrix3d back = rotation.transpose();
    return {1.0 / scale, back, back * translation / -scale};
  }

  /// The one on the right first, as with matrices.
  [[nodiscard]] friend similarity_transform operator*(const similarity_transform& second,
                                                      const similarity_transform& first) {
    return {second.scale * first.scale, second.rotation * first.rotation, second(first.translation)};
  }
};

/// What an alignment may change besides the translation.
enum class alignment_kind {
  rigid,      ///< the rotation
  similarity  ///< the rotation and the scale
};

namespace detail {

/// Points without their weighted centroid, each times the root of its share of the weights.
struct centred_points {
  Eigen::Vector3d centroid;
  point_columns scaled;

  centred_points(const point_columns& points, const Eigen::VectorXd& shares)
      : centroid(points * shares), scaled((points.colwise() - centroid) * shares.cwiseSqrt().asDiagonal()) {}
};

/// The shares of all weights: 1/n each if there are none.
[[nodiscard]] inline Eigen::VectorXd weight_shares(const Eigen::VectorXd& weights, Eigen::Index points) {
  const Eigen::VectorXd given = weights.size() > 0 ? weights : Eigen::VectorXd::Ones(points);
  if (given.size() != points)
    throw error("an alignment of " + std::to_string(points) + " points is given " + std::to_string(given.size()) +
                " weights");
  if (!given.allFinite() || (points > 0 && given.minCoeff() < 0.0))
    throw error("the weights of an alignment must be finite and not negative");
  if ((given.array() > 0.0).count() < 3)
    throw error("an alignment needs three points of positive weight, not " +
                std::to_string((given.array() > 0.0).count()));
  return given / given.maxCoeff() / (given / given.maxCoeff()).sum();
}

/// Root of the summed squares of the distances from the centroid.
[[nodiscard]] inline double centroid_size(const point_columns& points) {
  const Eigen::Vector3d centroid = points.rowwise().mean();
  return (points.colwise() - centroid).norm();
}

}  // namespace detail

/// The transform T that minimises sum_i weights_i |T(from_i) - onto_i|^2 over corresponded points; a mirror image is
/// never made. Without weights all points count the same. O(points).
///
/// Throws gonio::error if the numbers of points or weights differ, anything is not finite, a weight is negative, fewer
/// than three points have weight, or the points leave the rotation undetermined: those on one side all lie on a line,
/// or onto is so close to a mirror image that two rotations are equally good. Eigen::umeyama, which has no weights,
/// says nothing in these cases.
[[nodiscard]] inline similarity_transform align(const point_columns& from, const point_columns& onto,
                                                alignment_kind kind = alignment_kind::rigid,
                                                const Eigen::VectorXd& weights = {}) {
  if (from.cols() != onto.cols())
    throw error("an alignment needs corresponded points, not " + std::to_string(from.cols()) + " and " +
                std::to_string(onto.cols()));
  if (!from.allFinite() || !onto.allFinite()) throw error("the points of an alignment must be finite");
  const Eigen::VectorXd shares = detail::weight_shares(weights, from.cols());
  const detail::centred_points source(from, shares), target(onto, shares);
  const Eigen::Matrix3d covariance = target.scaled * source.scaled.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.info() != Eigen::Success) throw error("the points of an alignment are too far apart to be squared");
  Eigen::Vector3d singular = svd.singularValues();
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs[2] = -1.0;
  singular = singular.cwiseProduct(signs);
  // How much the sum of squares rises with a small turn, about the axis about which it rises least.
  const double stiffness = singular[1] + singular[2];
  constexpr double undetermined = 1e-9;
  if (!(stiffness > undetermined * source.scaled.norm() * target.scaled.norm()))
    throw error("the points of an alignment leave the rotation undetermined: do they lie on a line?");

  similarity_transform found;
  found.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  if (kind == alignment_kind::similarity) found.scale = singular.sum() / source.scaled.squaredNorm();
  found.translation = target.centroid - found.scale * (found.rotation * source.centroid);
  return found;
}

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

inline void require_corresponded(const std::vector<point_columns>& shapes, const procrustes_options& options) {
  if (shapes.empty()) throw error("a Procrustes mean needs at least one shape");
  if (!(options.tolerance > 0.0) || options.most_iterations < 1)
    throw error("a Procrustes mean needs a positive tolerance and at least one iteration");
  for (std::size_t i = 1; i < shapes.size(); ++i)
    if (shapes[i].cols() != shapes[0].cols())
      throw error("shape " + std::to_string(i) + " has " + std::to_string(shapes[i].cols()) +
                  " points where the first has " + std::to_string(shapes[0].cols()));
}

[[nodiscard]] inline point_columns mean_of_shapes(const std::vector<point_columns>& shapes) {
  point_columns sum = shapes.front();
  for (std::size_t i = 1; i < shapes.size(); ++i) sum += shapes[i];
  return sum / static_cast<double>(shapes.size());
}

/// About its centroid.
inline void rescale(point_columns& shape, double size) {
  const Eigen::Vector3d centroid = shape.rowwise().mean();
  const double factor = size / centroid_size(shape);
  shape = ((shape.colwise() - centroid) * factor).colwise() + centroid;
}

}  // namespace detail

/// Aligns each shape with the mean of all, over and over until the mean stands still. The first mean is the first
/// shape, in whose coordinates the result is. With similarities, which alone would shrink all shapes to a point, the
/// mean keeps the mean centroid size of the given shapes, so that lengths keep their unit; with rigid transforms it is
/// the plain mean of the aligned shapes. O(points x shapes) for an iteration.
///
/// Throws gonio::error where `align` does, if there is no shape or their sizes differ, and if the mean still changes
/// after the last iteration.
[[nodiscard]] inline aligned_shapes procrustes_mean(const std::vector<point_columns>& shapes,
                                                    const procrustes_options& options = {}) {
  detail::require_corresponded(shapes, options);
  double size = 0.0;
  for (const point_columns& shape : shapes) size += detail::centroid_size(shape) / static_cast<double>(shapes.size());
  const auto settle = [&](point_columns& mean) {
    if (options.kind == alignment_kind::similarity) detail::rescale(mean, size);
  };
  aligned_shapes result{shapes, shapes.front(), 0};
  settle(result.mean);
  while (result.iterations < options.most_iterations) {
    ++result.iterations;
    for (std::size_t i = 0; i < shapes.size(); ++i)
      result.shapes[i] = align(shapes[i], result.mean, options.kind)(shapes[i]);
    point_columns mean = detail::mean_of_shapes(result.shapes);
    settle(mean);
    const double change = (mean - result.mean).norm();
    result.mean = std::move(mean);
    if (change <= options.tolerance * size) return result;
  }
  throw error("a Procrustes mean of " + std::to_string(shapes.size()) + " shapes still changes after " +
              std::to_string(options.most_iterations) + " iterations");
}

}  // namespace gonio
