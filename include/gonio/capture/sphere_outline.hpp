#pragma once
/// Where a sphere of known radius is, from its outline in a photograph. Its rays touch it along a cone around the axis
/// to its centre, which the image cuts in an ellipse. Rays d (unit vectors, after the lens' distortion is undone) of
/// the outline lie in a plane, n . d = 1 with n = c / cos(alpha): the centre is in the direction c, at the distance
/// R / sin(alpha). Outliers, such as the border of the shadow, are left out by M. Fischler and R. Bolles, "Random
/// Sample Consensus", 1981 (doi:10.1145/358669.358692).

#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/surface_photograph.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace gonio::capture {

/// A circle in the image that somebody has drawn around the sphere, in pixels.
struct outline_circle {
  double column = 0.0, row = 0.0, radius = 0.0;
};

struct outline_options {
  double inlier_distance = 0.75;  ///< pixels from the outline within which a place of the edge agrees with it
  Eigen::Index trials = 1000;     ///< outlines through three places of the edge
  std::uint64_t seed = 1;         ///< decides which three
  /// Where it is known, only those places count in the end at which it lights the sphere well: near its shadow the
  /// outline fades.
  std::optional<surface_light> light = {};
};

/// A sphere, and how well its outline is met.
struct fitted_outline {
  placed_sphere sphere;
  Eigen::Index edge_points = 0, inliers = 0;
  double deviation = 0.0;  ///< root mean square of the inliers' distances from the outline, pixels
};

/// The places (column, row) where something begins that differs from the background: the outermost ones of each row
/// and of each column, to a fraction of a pixel by how much of the pixel is covered. The background is the median of
/// the image's border. Throws gonio::error naming a pixel that is not a number, or if the image is all background.
/// O(pixels).
[[nodiscard]] std::vector<Eigen::Vector2d> edge_points(const image& photograph);

/// The sphere of a radius, in the camera's unit of length, that these places are the outline of. Throws gonio::error if
/// fewer than a third of them agree, or if they agree along less than a quarter of the outline: no sphere is found.
[[nodiscard]] fitted_outline fit_sphere(const std::vector<Eigen::Vector2d>& outline, const lens_camera& camera,
                                        double radius, const outline_options& options = {});

/// The same of a photograph of the camera's size, by its `edge_points`.
[[nodiscard]] fitted_outline find_sphere(const image& photograph, const lens_camera& camera, double radius,
                                         const outline_options& options = {});

/// Of the outlines of one sphere that stands still in `photographs` many, the one that most of its edge agrees with:
/// `find(i)` finds that of photograph i. It is no error if it refuses some, which a grazing lamp leaves a thin crescent
/// in. Throws gonio::error with its last refusal if it refuses all.
[[nodiscard]] fitted_outline fullest_outline(Eigen::Index photographs,
                                             const std::function<fitted_outline(Eigen::Index)>& find);

/// What `find_sphere` finds, of a circle, as near as a circle comes to the ellipse.
[[nodiscard]] fitted_outline sphere_within(const outline_circle& circle, const lens_camera& camera, double radius);

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/sphere_outline.ipp>
#endif
