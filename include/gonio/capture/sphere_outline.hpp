#pragma once
/// Locates a sphere of known radius from its outline in a photograph. The rays from the camera that touch the sphere
/// form a cone of half angle alpha around the axis to its centre; the cone's image is an ellipse. Rays d of the outline
/// (unit vectors, after undoing the lens distortion) lie in a plane, n . d = 1 with n = c / cos(alpha): the centre is
/// in the direction c, at the distance R / sin(alpha). Outliers, such as the border of a shadow, are rejected as in M.
/// Fischler and R. Bolles, "Random Sample Consensus", 1981 (doi:10.1145/358669.358692).

#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/outline_circle.hpp>
#include <gonio/capture/surface_photograph.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace gonio::capture {

struct outline_options {
  double inlier_distance = 0.75;  ///< largest distance in pixels of an inlier from the outline
  Eigen::Index trials = 1000;     ///< number of random triples of edge points
  std::uint64_t seed = 1;         ///< determines the triples
  /// If given, the final fit uses only edge points that this light reaches well, because the outline fades near
  /// shadows.
  std::optional<surface_light> light = {};
};

/// A sphere and the quality of the fit to its outline.
struct fitted_outline {
  placed_sphere sphere;
  Eigen::Index edge_points = 0, inliers = 0;
  double deviation = 0.0;  ///< root mean square distance of the inliers from the outline, pixels
};

/// Returns the outermost points (column, row) of each row and column of pixels that differ from the background. Partly
/// covered pixels give a point's position to a fraction of a pixel. The background is the median of the image's border.
/// Throws gonio::error for a pixel that is not a number (the message names the pixel), or if the image is all
/// background. O(pixels).
[[nodiscard]] std::vector<Eigen::Vector2d> edge_points(const image& photograph);

/// Returns the sphere of a given radius, in the camera's unit of length, that has these outline points. Throws
/// gonio::error for fewer than 12 points, if fewer than a third of the points agree, or if the points that agree cover
/// less than a quarter of the outline.
[[nodiscard]] fitted_outline fit_sphere(const std::vector<Eigen::Vector2d>& outline, const lens_camera& camera,
                                        double radius, const outline_options& options = {});

/// Returns the sphere in a photograph, found by its `edge_points`. The photograph must have the size of the camera's
/// image.
[[nodiscard]] fitted_outline find_sphere(const image& photograph, const lens_camera& camera, double radius,
                                         const outline_options& options = {});

/// Returns the outline with the most inliers among photographs of one static sphere. `find(i)` returns the outline in
/// photograph i. It may throw gonio::error for some photographs, such as one in which a grazing lamp leaves a thin
/// crescent. If `find` refuses all photographs, throws gonio::error with its last message.
[[nodiscard]] fitted_outline fullest_outline(Eigen::Index photographs,
                                             const std::function<fitted_outline(Eigen::Index)>& find);

/// Returns the sphere whose elliptic outline is closest to a circle that a user has drawn around it.
[[nodiscard]] fitted_outline sphere_within(const outline_circle& circle, const lens_camera& camera, double radius);

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/sphere_outline.ipp>
#endif
