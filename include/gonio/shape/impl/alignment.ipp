#pragma once
/// Bodies of shape/alignment.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/SVD>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE similarity_transform similarity_transform::inverse() const {
  const Eigen::Matrix3d back = rotation.transpose();
  return {1.0 / scale, back, back * translation / -scale};
}

}  // namespace gonio

namespace gonio::detail {

GONIO_INLINE centred_points::centred_points(const point_columns& points, const Eigen::VectorXd& shares)
    : centroid(points * shares), scaled((points.colwise() - centroid) * shares.cwiseSqrt().asDiagonal()) {}

GONIO_INLINE Eigen::VectorXd weight_shares(const Eigen::VectorXd& weights, Eigen::Index points) {
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

GONIO_INLINE double centroid_size(const point_columns& points) {
  const Eigen::Vector3d centroid = points.rowwise().mean();
  return (points.colwise() - centroid).norm();
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE similarity_transform align(const point_columns& from, const point_columns& onto, alignment_kind kind,
                                        const Eigen::VectorXd& weights) {
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

}  // namespace gonio

namespace gonio::detail {

GONIO_INLINE void require_corresponded(const std::vector<point_columns>& shapes, const procrustes_options& options) {
  if (shapes.empty()) throw error("a Procrustes mean needs at least one shape");
  if (!(options.tolerance > 0.0) || options.most_iterations < 1)
    throw error("a Procrustes mean needs a positive tolerance and at least one iteration");
  for (std::size_t i = 1; i < shapes.size(); ++i)
    if (shapes[i].cols() != shapes[0].cols())
      throw error("shape " + std::to_string(i) + " has " + std::to_string(shapes[i].cols()) +
                  " points where the first has " + std::to_string(shapes[0].cols()));
}

GONIO_INLINE point_columns mean_of_shapes(const std::vector<point_columns>& shapes) {
  point_columns sum = shapes.front();
  for (std::size_t i = 1; i < shapes.size(); ++i) sum += shapes[i];
  return sum / static_cast<double>(shapes.size());
}

GONIO_INLINE void rescale(point_columns& shape, double size) {
  const Eigen::Vector3d centroid = shape.rowwise().mean();
  const double factor = size / centroid_size(shape);
  shape = ((shape.colwise() - centroid) * factor).colwise() + centroid;
}

}  // namespace gonio::detail

namespace gonio {

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
