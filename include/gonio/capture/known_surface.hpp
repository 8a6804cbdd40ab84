#pragma once
/// Surfaces of known shape as a camera sees them: a sphere, a plane, or a map of normals. With them an image of a
/// curved object is one measurement for each pixel: Marschner et al. 2000 (doi:10.1364/AO.39.002592) for spheres,
/// Noell, Koehler and Stricker 2014 for objects of known shape. A mesh is seen
/// by shape/mesh_surface.hpp.

#include <gonio/core/arrays.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/table/surface_image.hpp>

#include <Eigen/Core>

#include <optional>
#include <string>

namespace gonio::capture {

/// A sphere in the camera's world.
struct placed_sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1.0;
};

/// A plane through a point, such as a white board; the normal has any length.
struct placed_plane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// What each pixel's middle sees of a sphere. Throws gonio::error if the camera is inside the sphere, or the radius is
/// not positive. O(pixels).
[[nodiscard]] surface_image surface_of(const placed_sphere& sphere, const lens_camera& camera);

/// What each pixel's middle sees of a plane, its front alone. Throws gonio::error if the normal has no length.
/// O(pixels).
[[nodiscard]] surface_image surface_of(const placed_plane& plane, const lens_camera& camera);

/// Vectors of the world for each pixel, of shape (rows, columns, 3).
using vector_map = xt::xtensor<float, 3>;

/// A surface from its normals, which have any length and are zero where nothing is seen, and from positions, which a
/// lamp at a finite distance needs. Throws gonio::error, by the maps' names, for a map of another size than the
/// camera's image, for a pixel that is not finite, or if all normals are zero. O(pixels).
[[nodiscard]] surface_image surface_of_maps(const vector_map& normals, const std::string& normals_name,
                                            const lens_camera& camera, const std::optional<vector_map>& positions = {},
                                            const std::string& positions_name = "positions");

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/known_surface.ipp>
#endif
