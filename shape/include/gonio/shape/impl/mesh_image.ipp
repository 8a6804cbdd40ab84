#pragma once
/// Bodies of shape/mesh_image.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/mesh_image.hpp>
#include <gonio/shape/triangle_mesh.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace gonio::shape {

GONIO_INLINE mesh_view mesh_view::of(const triangle_mesh& mesh, const Eigen::Vector3d& towards,
                                     const Eigen::Vector3d& up) {
  mesh_view view{towards, up};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double low = mesh.vertices(axis, 0), high = low;
    for (Eigen::Index v = 1; v < mesh.vertices.cols(); ++v) {
      low = std::min(low, mesh.vertices(axis, v));
      high = std::max(high, mesh.vertices(axis, v));
    }
    view.centre[axis] = 0.5 * (low + high);
  }
  double farthest = 0.0;
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    const Eigen::Vector3d away = mesh.vertices.col(v) - view.centre;
    farthest = std::max(farthest, away.norm());
  }
  view.radius = 1.02 * farthest;
  return view;
}

}  // namespace gonio::shape

namespace gonio::shape::detail {

/// An image and the depth of each pixel.
struct depth_image {
  image colours;
  std::vector<double> nearest;
};

/// Draws one triangle with corners (column, row, depth) and colours as columns.
GONIO_INLINE void draw_triangle(depth_image& onto, const Eigen::Matrix3d& corners, const Eigen::Matrix3d& colours) {
  const std::size_t pixels = onto.colours.shape(0);
  const auto last = static_cast<double>(pixels) - 1.0;
  const auto [left, right] = std::minmax({corners(0, 0), corners(0, 1), corners(0, 2)});
  const auto [top, bottom] = std::minmax({corners(1, 0), corners(1, 1), corners(1, 2)});
  if (!(right >= 0.0 && bottom >= 0.0 && left <= last + 1.0 && top <= last + 1.0)) return;
  Eigen::Matrix3d edges = corners;
  for (Eigen::Index corner = 0; corner < 3; ++corner) edges(2, corner) = 1.0;
  if (!(std::abs(edges.determinant()) > 1e-12)) return;  // seen edge-on
  const Eigen::Matrix3d shares_of = edges.inverse();
  const auto first_row = static_cast<std::size_t>(std::max(0.0, std::ceil(top - 0.5)));
  const auto first_column = static_cast<std::size_t>(std::max(0.0, std::ceil(left - 0.5)));
  for (std::size_t row = first_row; row < pixels && static_cast<double>(row) + 0.5 <= bottom; ++row)
    for (std::size_t column = first_column; column < pixels && static_cast<double>(column) + 0.5 <= right; ++column) {
      const Eigen::Vector3d middle(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5, 1.0),
          shares = shares_of * middle;
      if (shares.minCoeff() < -1e-9) continue;
      const double depth = corners(2, 0) * shares[0] + corners(2, 1) * shares[1] + corners(2, 2) * shares[2];
      double& nearest = onto.nearest[row * pixels + column];
      if (!(depth < nearest)) continue;
      nearest = depth;
      const Eigen::Vector3d colour = colours * shares;
      set_pixel(onto.colours, row, column, colour.array());
    }
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE image image_of(const triangle_mesh& mesh, std::span<const rgb> colours, const mesh_view& view) {
  if (std::ssize(colours) != mesh.vertices.cols())
    refuse({"an image of ", mesh.vertices.cols(), " vertices has ", colours.size(), " colours"});
  const Eigen::Vector3d right = view.towards.cross(view.up);
  if (!(view.radius > 0.0 && view.pixels > 0 && right.norm() > 0.0))
    refuse("an image of a mesh needs pixels, a radius and a direction other than up");
  const Eigen::Vector3d across = right / right.norm(), away = view.towards / view.towards.norm(),
                        down = away.cross(across);
  const double pixels = static_cast<double>(view.pixels), scale = 0.5 * pixels / view.radius;
  const point_columns normals = vertex_normals(mesh);
  point_columns seen(3, mesh.vertices.cols()), lit(3, mesh.vertices.cols());
  for (Eigen::Index v = 0; v < seen.cols(); ++v) {
    const Eigen::Vector3d from_centre = mesh.vertices.col(v) - view.centre, normal = normals.col(v);
    seen(0, v) = scale * across.dot(from_centre) + 0.5 * pixels;
    seen(1, v) = scale * down.dot(from_centre) + 0.5 * pixels;
    seen(2, v) = scale * away.dot(from_centre);
    const double facing = -away.dot(normal), light = facing >= 0.0 ? 0.15 + 0.85 * facing : 0.1 - 0.2 * facing;
    for (Eigen::Index c = 0; c < 3; ++c) lit(c, v) = light * colours[v][c];
  }
  detail::depth_image drawn{uniform_image(view.pixels, view.pixels, view.background),
                            std::vector<double>(view.pixels * view.pixels, std::numeric_limits<double>::infinity())};
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    Eigen::Matrix3d corners, corner_colours;
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
      corners.col(corner) = seen.col(mesh.triangles(corner, t));
      corner_colours.col(corner) = lit.col(mesh.triangles(corner, t));
    }
    detail::draw_triangle(drawn, corners, corner_colours);
  }
  return std::move(drawn.colours);
}

}  // namespace gonio::shape
