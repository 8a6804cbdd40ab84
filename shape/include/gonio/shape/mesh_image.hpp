#pragma once
/// Images of surfaces with a colour at each vertex, from far away, without any graphics library.

#include <gonio/core/rgb.hpp>
#include <gonio/shape/triangle_mesh.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace gonio::shape {

/// What is seen: parallel rays towards a ball in a square image that it fills.
struct mesh_view {
  Eigen::Vector3d towards = -Eigen::Vector3d::UnitZ();  ///< where the viewer looks, of any length
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1.0;
  std::size_t pixels = 400;
  rgb background = rgb::Constant(1.0);

  /// A view of a whole mesh.
  [[nodiscard]] static mesh_view of(const triangle_mesh& mesh, const Eigen::Vector3d& towards,
                                    const Eigen::Vector3d& up = Eigen::Vector3d::UnitY());
};

/// A mesh lit from the viewer: colours (a linear one for each vertex) times how directly the surface is seen. The
/// inside of an open surface is darker. O(triangles + pixels covered). Throws gonio::error for another number of
/// colours than vertices, or a view without extent or direction.
[[nodiscard]] image image_of(const triangle_mesh& mesh, std::span<const rgb> colours, const mesh_view& view);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/mesh_image.ipp>
#endif
