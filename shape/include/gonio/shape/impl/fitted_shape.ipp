#pragma once
/// Bodies of shape/fitted_shape.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/fitted_shape.hpp>
#include <gonio/shape/shape_basis.hpp>
#include <gonio/table/location.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace gonio::shape {

GONIO_INLINE vertex_observations vertex_observations::marked(const point_columns& shape,
                                                             const std::vector<bool>& known) {
  vertex_observations found;
  for (Eigen::Index v = 0; v < std::ssize(known); ++v)
    if (known[v]) found.vertices.push_back(v);
  found.positions = chosen_columns(shape, found.vertices);
  return found;
}

GONIO_INLINE std::vector<bool> marks_of(const vertex_observations& known, Eigen::Index vertices) {
  std::vector<bool> marks(vertices, false);
  for (const Eigen::Index vertex : known.vertices) marks[vertex] = true;
  return marks;
}

}  // namespace gonio::shape

namespace gonio::shape::detail {

/// Appends three locations of a vertex's x, y and z for the estimator: one along each unit column of `axes`.
GONIO_INLINE void locate_along(const Eigen::Matrix3d& axes, Eigen::Index vertex, std::vector<location>& at) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    location along;
    along.count = 3;
    for (int i = 0; i < 3; ++i) {
      along.cell[i] = static_cast<std::uint32_t>(3 * vertex + i);
      along.weight[i] = axes(i, axis);
    }
    at.push_back(along);
  }
}

/// Returns a normal and two tangents.
[[nodiscard]] GONIO_INLINE Eigen::Matrix3d axes_about(const Eigen::Vector3d& normal) {
  Eigen::Matrix3d axes;
  axes.col(0) = normal;
  axes.col(1) = normal.unitOrthogonal();
  axes.col(2) = normal.cross(axes.col(1));
  return axes;
}

GONIO_INLINE void require_known(const vertex_coordinates& coordinates, const vertex_observations& known) {
  const Eigen::Index count = std::ssize(known.vertices);
  if (count == 0) refuse("no vertex is known: there is nothing to predict a shape from");
  const auto none_or_all = [&](Eigen::Index size) { return size == 0 || size == count; };
  if (known.positions.cols() != count || !none_or_all(known.normals.cols()) || !none_or_all(known.weights.size()))
    refuse({count, " known vertices have ", known.positions.cols(), " positions, ", known.normals.cols(),
            " normals and ", known.weights.size(), " weights"});
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index vertex = known.vertices[i];
    if (vertex < 0 || vertex >= coordinates.vertices)
      refuse({"vertex ", vertex, " is known, but the shapes have ", coordinates.vertices, " vertices"});
    if (!known.positions.col(i).allFinite()) refuse({"the position of known vertex ", vertex, " is not finite"});
    if (known.normals.cols() != 0 && !(std::abs(known.normals.col(i).norm() - 1.0) < 1e-6))
      refuse({"the normal at known vertex ", vertex, " does not have length 1"});
  }
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE located_samples locate_vertices(const vertex_coordinates& coordinates, const vertex_observations& known) {
  detail::require_known(coordinates, known);
  located_samples found;
  found.locations.reserve(3 * known.vertices.size());
  found.values.resize(3 * known.vertices.size(), 1);
  found.weights = Eigen::MatrixXd::Ones(found.values.rows(), 1);
  for (Eigen::Index i = 0; i < std::ssize(known.vertices); ++i) {
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    if (known.normals.cols() != 0) {
      axes = detail::axes_about(known.normals.col(i));
      found.weights(3 * i + 1, 0) = found.weights(3 * i + 2, 0) = known.tangential;
    }
    detail::locate_along(axes, known.vertices[i], found.locations);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (known.weights.size() != 0) found.weights(3 * i + axis, 0) *= known.weights[i];
      found.values(3 * i + axis, 0) = axes.col(axis).dot(known.positions.col(i));
    }
  }
  return found;
}

GONIO_INLINE fitted_shape::fitted_shape(shape_basis basis, solution found)
    : basis_(std::move(basis)), report_(std::move(found.report)) {
  if (found.weights.rows() != basis_.size() || found.weights.cols() != 1)
    refuse({"a shape of ", basis_.size(), " functions needs one weight for each"});
  weights_ = found.weights.col(0);
}

GONIO_INLINE Eigen::Vector3d fitted_shape::vertex(Eigen::Index number) const {
  Eigen::Vector3d position;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Index coordinate = 3 * number + axis;
    position[axis] = basis_.offset(coordinate);
    for (Eigen::Index i = 0; i < weights_.size(); ++i)
      position[axis] += basis_.components()(coordinate, i) * weights_[i];
  }
  return position;
}

}  // namespace gonio::shape
