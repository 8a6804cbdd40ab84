#pragma once
/// Renders surfaces with a colour at each vertex in parallel projection, without a graphics library.

#include <gonio/core/rgb.hpp>
#include <gonio/shape/triangle_mesh.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace gonio::shape {

/// The view: parallel rays, and a ball that fills the square image.
struct mesh_view {
  Eigen::Vector3d towards = -Eigen::Vector3d::UnitZ();  ///< viewing direction, of any length
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1.0;
  std::size_t pixels = 400;
  rgb background = rgb::Constant(1.0);

  /// Returns a view of a whole mesh.
  [[nodiscard]] static mesh_view of(const triangle_mesh& mesh, const Eigen::Vector3d& towards,
                                    const Eigen::Vector3d& up = Eigen::Vector3d::UnitY());
};

/// Renders a mesh lit from the viewer. Let c be the cosine of the angle between a vertex's normal and the viewer. The
/// vertex's linear colour is multiplied by 0.15 + 0.85 c, or on the inside of an open surface (c < 0) by 0.1 - 0.2 c.
/// O(triangles + pixels covered). Throws gonio::error if the numbers of colours and vertices differ, or for a view
/// without extent or direction.
[[nodiscard]] image image_of(const triangle_mesh& mesh, std::span<const rgb> colours, const mesh_view& view);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/mesh_image.ipp>
#endif
