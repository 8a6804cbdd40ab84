#pragma once
/// Surfaces of known shape as seen by a camera: a sphere, a plane, or a map of normals. With a known shape, each pixel
/// of a curved object's image is a measurement: Marschner et al. 2000 (doi:10.1364/AO.39.002592) for spheres, Noell,
/// Koehler and Stricker 2014 for objects of known shape. shape/mesh_surface.hpp has meshes.

#include <gonio/core/arrays.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/table/surface_image.hpp>

#include <Eigen/Core>

#include <optional>
#include <string>

namespace gonio::capture {

/// A sphere in the camera's world coordinates.
struct placed_sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1.0;
};

/// A plane through a point, such as a white board. The normal may have any length.
struct placed_plane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// Returns the sphere's point and normal at the centre of each pixel. Throws gonio::error if the camera is inside the
/// sphere, or if the radius is not positive. O(pixels).
[[nodiscard]] surface_image surface_of(const placed_sphere& sphere, const lens_camera& camera);

/// Returns the plane's point and normal at the centre of each pixel. Only its front is visible. Throws gonio::error if
/// the normal is zero. O(pixels).
[[nodiscard]] surface_image surface_of(const placed_plane& plane, const lens_camera& camera);

/// One world vector per pixel, shape (rows, columns, 3).
using vector_map = xt::xtensor<float, 3>;

/// Returns a surface from maps of its normals and positions. Normals may have any length, and zero marks pixels that do
/// not see the surface. A lamp at a finite distance needs the positions. Throws gonio::error that names the map if the
/// map's size differs from the camera's image, if a pixel is not finite, or if all normals are zero. O(pixels).
[[nodiscard]] surface_image surface_of_maps(const vector_map& normals, const std::string& normals_name,
                                            const lens_camera& camera, const std::optional<vector_map>& positions = {},
                                            const std::string& positions_name = "positions");

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/known_surface.ipp>
#endif
