#pragma once
/// Bodies of shape/alignment.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace gonio::shape {

GONIO_INLINE Eigen::Vector3d similarity_transform::moved_point(const Eigen::Vector3d& point) const {
  const Eigen::Matrix3d turn = scale * rotation;
  Eigen::Vector3d moved;
  for (Eigen::Index i = 0; i < 3; ++i)
    moved[i] = turn(i, 0) * point[0] + turn(i, 1) * point[1] + turn(i, 2) * point[2] + translation[i];
  return moved;
}

GONIO_INLINE point_columns similarity_transform::moved_points(const point_columns& points) const {
  point_columns moved(3, points.cols());
  for (Eigen::Index v = 0; v < points.cols(); ++v) moved.col(v) = moved_point(points.col(v));
  return moved;
}

GONIO_INLINE similarity_transform similarity_transform::inverse() const {
  const Eigen::Matrix3d back = rotation.transpose();
  const Eigen::Vector3d turned = back * translation;
  return {1.0 / scale, back, turned / -scale};
}

GONIO_INLINE similarity_transform similarity_transform::after(const similarity_transform& first) const {
  return {scale * first.scale, rotation * first.rotation, moved_point(first.translation)};
}

}  // namespace gonio::shape

namespace gonio::shape::detail {

/// Points minus their weighted centroid, each times the square root of its relative weight.
struct centred_points {
  Eigen::Vector3d centroid;
  point_columns scaled;

  centred_points(const point_columns& points, const Eigen::VectorXd& shares);
};

GONIO_INLINE centred_points::centred_points(const point_columns& points, const Eigen::VectorXd& shares)
    : centroid(Eigen::Vector3d::Zero()), scaled(points) {
  for (Eigen::Index v = 0; v < points.cols(); ++v)
    for (Eigen::Index i = 0; i < 3; ++i) centroid[i] += shares[v] * points(i, v);
  for (Eigen::Index v = 0; v < points.cols(); ++v) {
    const double root = std::sqrt(shares[v]);
    for (Eigen::Index i = 0; i < 3; ++i) scaled(i, v) = root * (points(i, v) - centroid[i]);
  }
}

/// Returns weights that sum to 1: 1/n each if none are given.
[[nodiscard]] GONIO_INLINE Eigen::VectorXd weight_shares(const Eigen::VectorXd& weights, Eigen::Index points) {
  Eigen::VectorXd shares = weights.size() > 0 ? weights : Eigen::VectorXd::Ones(points);
  if (shares.size() != points) refuse({"an alignment of ", points, " points has ", shares.size(), " weights"});
  if (std::ranges::any_of(shares, [](double weight) { return !(weight >= 0.0 && std::isfinite(weight)); }))
    refuse("the weights of an alignment must be finite and not negative");
  const auto positive = std::ranges::count_if(shares, [](double weight) { return weight > 0.0; });
  if (positive < 3) refuse({"an alignment needs three points of positive weight, not ", positive});
  shares /= shares.maxCoeff();  // keeps the sum from overflowing
  shares /= shares.sum();
  return shares;
}

/// Returns the sum of a_i b_i' over the columns.
[[nodiscard]] GONIO_INLINE Eigen::Matrix3d sum_of_outer_products(const point_columns& a, const point_columns& b) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (Eigen::Index v = 0; v < a.cols(); ++v)
    for (Eigen::Index j = 0; j < 3; ++j)
      for (Eigen::Index i = 0; i < 3; ++i) sum(i, j) += a(i, v) * b(j, v);
  return sum;
}

GONIO_INLINE double centroid_size(const point_columns& points) {
  const Eigen::Vector3d centroid = centroid_of(points);
  double sum = 0.0;
  for (Eigen::Index v = 0; v < points.cols(); ++v)
    for (Eigen::Index i = 0; i < 3; ++i) sum += (points(i, v) - centroid[i]) * (points(i, v) - centroid[i]);
  return std::sqrt(sum);
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE similarity_transform align(const point_columns& from, const point_columns& onto, alignment_kind kind,
                                        const Eigen::VectorXd& weights) {
  if (from.cols() != onto.cols())
    refuse({"an alignment needs corresponded points, not ", from.cols(), " and ", onto.cols()});
  if (!from.allFinite() || !onto.allFinite()) refuse("the points of an alignment must be finite");
  const Eigen::VectorXd shares = detail::weight_shares(weights, from.cols());
  const detail::centred_points source(from, shares), target(onto, shares);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(detail::sum_of_outer_products(target.scaled, source.scaled),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.info() != Eigen::Success)
    refuse("the points of an alignment are so far apart that their squared distances overflow");
  Eigen::Vector3d singular = svd.singularValues();
  Eigen::Matrix3d left = svd.matrixU();
  if (left.determinant() * svd.matrixV().determinant() < 0.0) {  // never a mirror image
    singular[2] = -singular[2];
    left.col(2) = -left.col(2);
  }
  // The curvature of the sum of squares about its least determined rotation axis.
  const double stiffness = singular[1] + singular[2];
  constexpr double undetermined = 1e-9;
  if (!(stiffness > undetermined * source.scaled.norm() * target.scaled.norm()))
    refuse("the points of an alignment leave the rotation undetermined: do they lie on a line?");

  similarity_transform found;
  found.rotation = left * svd.matrixV().transpose();
  if (kind == alignment_kind::similarity) found.scale = singular.sum() / source.scaled.squaredNorm();
  found.translation = target.centroid - found.scale * (found.rotation * source.centroid);
  return found;
}

}  // namespace gonio::shape

namespace gonio::shape::detail {

GONIO_INLINE void require_corresponded(const std::vector<point_columns>& shapes, const procrustes_options& options) {
  if (shapes.empty()) refuse("a Procrustes mean needs at least one shape");
  if (!(options.tolerance > 0.0) || options.most_iterations < 1)
    refuse("a Procrustes mean needs a positive tolerance and at least one iteration");
  for (Eigen::Index i = 1; i < std::ssize(shapes); ++i)
    if (shapes[i].cols() != shapes[0].cols())
      refuse({"shape ", i, " has ", shapes[i].cols(), " points where the first has ", shapes[0].cols()});
}

[[nodiscard]] GONIO_INLINE point_columns mean_of_shapes(const std::vector<point_columns>& shapes) {
  point_columns sum = shapes.front();
  for (Eigen::Index i = 1; i < std::ssize(shapes); ++i) sum += shapes[i];
  return sum / static_cast<double>(shapes.size());
}

/// Scales a shape about its centroid to a centroid size.
GONIO_INLINE void rescale(point_columns& shape, double size) {
  const Eigen::Vector3d centroid = centroid_of(shape);
  const double factor = size / centroid_size(shape);
  for (Eigen::Index v = 0; v < shape.cols(); ++v)
    for (Eigen::Index i = 0; i < 3; ++i) shape(i, v) = centroid[i] + factor * (shape(i, v) - centroid[i]);
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE aligned_shapes procrustes_mean(const std::vector<point_columns>& shapes,
                                            const procrustes_options& options) {
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
    for (Eigen::Index i = 0; i < std::ssize(shapes); ++i)
      result.shapes[i] = align(shapes[i], result.mean, options.kind)(shapes[i]);
    point_columns mean = detail::mean_of_shapes(result.shapes);
    settle(mean);
    const double change = (mean - result.mean).norm();
    result.mean = std::move(mean);
    if (change <= options.tolerance * size) return result;
  }
  refuse(
      {"a Procrustes mean of ", shapes.size(), " shapes still changes after ", options.most_iterations, " iterations"});
}

}  // namespace gonio::shape
