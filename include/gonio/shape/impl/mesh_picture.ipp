#pragma once
/// Bodies of shape/mesh_picture.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/mesh_picture.hpp>
#include <gonio/shape/triangle_mesh.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE mesh_view mesh_view::of(const triangle_mesh& mesh, const Eigen::Vector3d& towards,
                                     const Eigen::Vector3d& up) {
  mesh_view view{towards, up};
  view.centre = 0.5 * (mesh.vertices.rowwise().minCoeff() + mesh.vertices.rowwise().maxCoeff());
  view.radius = 1.02 * (mesh.vertices.colwise() - view.centre).colwise().norm().maxCoeff();
  return view;
}

}  // namespace gonio

namespace gonio::detail {

GONIO_INLINE void draw_triangle(depth_picture& onto, const Eigen::Matrix3d& corners, const Eigen::Matrix3d& colours) {
  const std::size_t pixels = onto.picture.shape(0);
  const auto last = static_cast<double>(pixels) - 1.0;
  const Eigen::Vector2d low = corners.topRows<2>().rowwise().minCoeff(),
                        high = corners.topRows<2>().rowwise().maxCoeff();
  if (!(high.minCoeff() >= 0.0 && low.maxCoeff() <= last + 1.0)) return;
  Eigen::Matrix3d edges;
  edges << corners.topRows<2>(), Eigen::RowVector3d::Ones();
  if (!(std::abs(edges.determinant()) > 1e-12)) return;  // seen edge-on
  const Eigen::Matrix3d shares_of = edges.inverse();
  const auto first_row = static_cast<std::size_t>(std::max(0.0, std::ceil(low.y() - 0.5)));
  const auto first_column = static_cast<std::size_t>(std::max(0.0, std::ceil(low.x() - 0.5)));
  for (std::size_t row = first_row; row < pixels && static_cast<double>(row) + 0.5 <= high.y(); ++row)
    for (std::size_t column = first_column; column < pixels && static_cast<double>(column) + 0.5 <= high.x();
         ++column) {
      const Eigen::Vector3d shares =
          shares_of * Eigen::Vector3d(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5, 1.0);
      if (shares.minCoeff() < -1e-9) continue;
      const double depth = corners.row(2).dot(shares);
      double& nearest = onto.nearest[row * pixels + column];
      if (!(depth < nearest)) continue;
      nearest = depth;
      set_pixel(onto.picture, row, column, (colours * shares).array());
    }
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE image picture_of(const triangle_mesh& mesh, std::span<const rgb> colours, const mesh_view& view) {
  if (static_cast<Eigen::Index>(colours.size()) != mesh.vertices.cols())
    throw error("a picture of " + std::to_string(mesh.vertices.cols()) + " vertices is given " +
                std::to_string(colours.size()) + " colours");
  const Eigen::Vector3d right = view.towards.cross(view.up);
  if (!(view.radius > 0.0 && view.pixels > 0 && right.norm() > 0.0))
    throw error("a picture of a mesh needs pixels, a radius and a direction that is not that of up");
  Eigen::Matrix3d frame;  // right, down, away
  frame.row(0) = right.normalized();
  frame.row(2) = view.towards.normalized();
  frame.row(1) = frame.row(2).cross(frame.row(0));
  const auto pixels = static_cast<double>(view.pixels);
  Eigen::Matrix3Xd seen = frame * (mesh.vertices.colwise() - view.centre) * (0.5 * pixels / view.radius);
  seen.topRows<2>().array() += 0.5 * pixels;

  const point_columns normals = vertex_normals(mesh);
  Eigen::Matrix3Xd lit(3, mesh.vertices.cols());
  for (Eigen::Index v = 0; v < lit.cols(); ++v) {
    const double facing = -frame.row(2).dot(normals.col(v));
    lit.col(v) = colours[static_cast<std::size_t>(v)] * (facing >= 0.0 ? 0.15 + 0.85 * facing : 0.1 - 0.2 * facing);
  }
  detail::depth_picture drawn{uniform_image(view.pixels, view.pixels, view.background),
                              std::vector<double>(view.pixels * view.pixels, std::numeric_limits<double>::infinity())};
  for (const auto& corners : mesh.triangles.colwise())
    detail::draw_triangle(drawn, seen(Eigen::all, corners), lit(Eigen::all, corners));
  return std::move(drawn.picture);
}

}  // namespace gonio
