#pragma once
/// Locates a sphere of known radius from its outline in a photograph. The rays that touch it form a cone around the
/// axis to its centre; the cone's image is an ellipse. Rays d of the outline (unit vectors, after undoing the lens
/// distortion) lie in a plane, n . d = 1 with n = c / cos(alpha): the centre is in the direction c, at the distance R /
/// sin(alpha). Outliers, such as the shadow's border, are rejected by M. Fischler and R. Bolles, "Random Sample
/// Consensus", 1981 (doi:10.1145/358669.358692).

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

/// A circle that a user has drawn around the sphere in the image, in pixels.
struct outline_circle {
  double column = 0.0, row = 0.0, radius = 0.0;
};

struct outline_options {
  double inlier_distance = 0.75;  ///< largest distance of an inlier from the outline, pixels
  Eigen::Index trials = 1000;     ///< number of random triples of edge points
  std::uint64_t seed = 1;         ///< chooses the triples
  /// If given, the final fit uses only edge points that it lights well, because the outline fades near shadows.
  std::optional<surface_light> light = {};
};

/// A sphere and the quality of its outline.
struct fitted_outline {
  placed_sphere sphere;
  Eigen::Index edge_points = 0, inliers = 0;
  double deviation = 0.0;  ///< root mean square distance of the inliers from the outline, pixels
};

/// Returns the outermost points (column, row) of each row and column that differ from the background. The covered part
/// of a pixel gives the position to a fraction of a pixel. The background is the median of the image's border. Throws
/// gonio::error that names a pixel which is not a number, or if the image is all background. O(pixels).
[[nodiscard]] std::vector<Eigen::Vector2d> edge_points(const image& photograph);

/// Returns the sphere with this radius, in the camera's unit of length, that has these outline points. Throws
/// gonio::error if fewer than a third of them agree, or if they cover less than a quarter of the outline.
[[nodiscard]] fitted_outline fit_sphere(const std::vector<Eigen::Vector2d>& outline, const lens_camera& camera,
                                        double radius, const outline_options& options = {});

/// Returns the sphere in a photograph of the camera's size, by its `edge_points`.
[[nodiscard]] fitted_outline find_sphere(const image& photograph, const lens_camera& camera, double radius,
                                         const outline_options& options = {});

/// Returns the outline with the most inliers among photographs of one static sphere. `find(i)` returns the outline in
/// photograph i. It may refuse some photographs, such as one in which a grazing lamp leaves a thin crescent. If it
/// refuses all, throws gonio::error with its last refusal.
[[nodiscard]] fitted_outline fullest_outline(Eigen::Index photographs,
                                             const std::function<fitted_outline(Eigen::Index)>& find);

/// Returns the sphere whose elliptic outline is closest to a circle.
[[nodiscard]] fitted_outline sphere_within(const outline_circle& circle, const lens_camera& camera, double radius);

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/sphere_outline.ipp>
#endif
