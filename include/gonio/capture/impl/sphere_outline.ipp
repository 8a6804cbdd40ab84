#pragma once
/// Bodies of capture/sphere_outline.hpp.

#include <gonio/capture/sphere_outline.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/lens_distortion.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/table/image.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace gonio::capture::detail {

/// The brightness difference of each pixel from the background, and a threshold above the background's noise.
struct contrast_image {
  Eigen::Index rows = 0, columns = 0;
  std::vector<double> values;
  double threshold = 0.0;

  [[nodiscard]] double at(Eigen::Index row, Eigen::Index column) const { return values[row * columns + column]; }
};

/// Returns the threshold for a difference from the background: at least the background's noise and a fraction of the
/// sphere's median difference. Ignores the few brightest pixels, because a highlight may be a hundred times brighter
/// than the rest of the sphere.
GONIO_INLINE double threshold_of(std::vector<double> values, double noise) {
  constexpr double share_of_highlight = 1e-3, share_of_median = 0.05;
  const std::ptrdiff_t wrong = std::max<std::ptrdiff_t>(20, std::ssize(values) / 1000);
  const double bright = nth_smallest(values, std::max<std::ptrdiff_t>(std::ssize(values) - 1 - wrong, 0));
  const double least = std::max(6.0 * noise, share_of_highlight * bright);
  if (!(bright > least)) gonio::refuse("no sphere is found: nothing in the image differs from its border");
  std::erase_if(values, [&](double each) { return each <= least; });
  return std::max(least, share_of_median * median(std::move(values)));
}

GONIO_INLINE contrast_image contrast_of(const image& photograph) {
  contrast_image contrast{
      static_cast<Eigen::Index>(photograph.shape(0)), static_cast<Eigen::Index>(photograph.shape(1)), {}};
  if (contrast.rows < 8 || contrast.columns < 8) gonio::refuse("a photograph of a sphere needs at least 8 x 8 pixels");
  // Compute each pixel's brightness. The border of the image shows the background.
  std::vector<double> border;
  for (Eigen::Index row = 0; row < contrast.rows; ++row)
    for (Eigen::Index column = 0; column < contrast.columns; ++column) {
      const rgb value = pixel(photograph, row, column);
      if (value.isNaN().any()) gonio::refuse({"pixel (row ", row, ", column ", column, ") is not a number"});
      contrast.values.push_back(std::min(value.sum(), 1e30));
      const bool is_border = row == 0 || column == 0 || row == contrast.rows - 1 || column == contrast.columns - 1;
      if (is_border) border.push_back(contrast.values.back());
    }
  const double background = median(border);
  for (double& each : border) each = std::abs(each - background);
  const double noise = deviation_by_median * median(std::move(border));
  for (double& each : contrast.values) each = std::abs(each - background);
  contrast.threshold = threshold_of(contrast.values, noise);
  return contrast;
}

/// Returns the position of the first edge along a line of pixels, from pixel 0 inwards. Returns nothing if the edge is
/// at the border of the image.
template <class Read>
[[nodiscard]] std::optional<double> first_edge(Eigen::Index count, double threshold, const Read& read) {
  for (Eigen::Index i = 0; i + 4 < count; ++i) {
    if (!(read(i) > threshold && read(i + 1) > threshold && read(i + 2) > threshold)) continue;
    if (i == 0) return {};
    // The edge covers parts of two pixels. Pixels farther inwards are covered fully; extrapolate their brightness to
    // the edge.
    const double inner = read(i + 2), level = std::clamp(2.0 * inner - read(i + 3), 0.3 * inner, 3.0 * inner);
    return static_cast<double>(i + 2) - std::clamp((read(i) + read(i + 1)) / level, 0.0, 2.0);
  }
  return {};
}

/// Keeps the edges at which the line crosses the outline steeply. On other lines, the edges of neighbouring lines are
/// too far apart.
template <class Scan, class Keep>
void add_steep_edges(Eigen::Index lines, const Scan& scan, const Keep& keep) {
  constexpr double farthest = 1.2;
  std::vector<std::optional<double>> edges;
  for (Eigen::Index line = 0; line < lines; ++line) edges.push_back(scan(line));
  for (Eigen::Index line = 1; line + 1 < lines; ++line) {
    const auto &before = edges[line - 1], &here = edges[line], &after = edges[line + 1];
    if (!before || !here || !after) continue;
    if (std::abs(*here - *before) > farthest || std::abs(*after - *here) > farthest) continue;
    keep(*here, static_cast<double>(line) + 0.5);
  }
}

/// Returns the vector n of the plane n . d = 1 that is nearest to the chosen rays d.
GONIO_INLINE Eigen::Vector3d plane_of(const Eigen::Matrix3Xd& rays, const std::vector<Eigen::Index>& chosen) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Index i : chosen) {
    const Eigen::Vector3d d = rays.col(i);
    for (Eigen::Index a = 0; a < 3; ++a) {
      sum[a] += d[a];
      for (Eigen::Index b = 0; b < 3; ++b) normal(a, b) += d[a] * d[b];
    }
  }
  const Eigen::Matrix3d inverse = normal.inverse();
  return inverse * sum;
}

/// Returns the angle in radians by which each ray is outside the cone of a plane; negative inside.
GONIO_INLINE Eigen::VectorXd beyond_cone(const Eigen::Matrix3Xd& rays, const Eigen::Vector3d& plane) {
  const double length = plane.norm(), half_angle = std::acos(std::min(1.0 / length, 1.0));
  Eigen::VectorXd beyond(rays.cols());
  for (Eigen::Index i = 0; i < rays.cols(); ++i) {
    const Eigen::Vector3d d = rays.col(i);
    const Eigen::Vector3d across = d.cross(plane);
    beyond[i] = std::atan2(across.norm(), d.dot(plane)) - half_angle;
  }
  return beyond;
}

GONIO_INLINE std::vector<Eigen::Index> within(const Eigen::VectorXd& beyond, double tolerance) {
  std::vector<Eigen::Index> inliers;
  for (Eigen::Index i = 0; i < beyond.size(); ++i)
    if (std::abs(beyond[i]) <= tolerance) inliers.push_back(i);
  return inliers;
}

/// Returns true if a plane gives a cone with a half angle between three pixels and a right angle.
GONIO_INLINE bool is_cone(const Eigen::Vector3d& plane, double pixel_angle) {
  const double length = plane.norm();
  return std::isfinite(length) && length > 1.0 && std::acos(1.0 / length) > 3.0 * pixel_angle;
}

/// Returns the best of many planes, each through three random rays: the plane whose cone has the most rays on it and
/// the fewest outside.
GONIO_INLINE std::optional<Eigen::Vector3d> consensus(const Eigen::Matrix3Xd& rays, double tolerance,
                                                      double pixel_angle, const outline_options& options) {
  std::mt19937_64 generator(options.seed);
  const auto count = static_cast<double>(rays.cols());
  const auto any = [&] {
    return std::min(static_cast<Eigen::Index>(uniform_number(generator) * count), rays.cols() - 1);
  };
  std::optional<Eigen::Vector3d> best;
  double best_score = 0.0;
  for (Eigen::Index trial = 0; trial < options.trials; ++trial) {
    const Eigen::Index i = any(), j = any(), k = any();
    if (i == j || j == k || i == k) continue;
    const Eigen::Vector3d plane = plane_of(rays, {i, j, k});
    if (!is_cone(plane, pixel_angle)) continue;
    const Eigen::VectorXd beyond = beyond_cone(rays, plane);
    double score = 0.0;
    for (const double each : beyond) {
      if (std::abs(each) <= tolerance) score += 1.0 - std::pow(each / tolerance, 2);
      if (each > tolerance) score -= 1.0;  // no ray of the sphere's edge is outside its cone
    }
    if (score <= best_score) continue;
    best_score = score;
    best = plane;
  }
  return best;
}

/// Returns the fraction of the outline that the inliers cover, counted in sectors of 10 degrees.
GONIO_INLINE double covered_share(const Eigen::Matrix3Xd& rays, const std::vector<Eigen::Index>& inliers,
                                  const Eigen::Vector3d& plane) {
  const Eigen::Vector3d axis = plane.normalized(), across = axis.unitOrthogonal(), beside = axis.cross(across);
  std::vector<bool> seen(36, false);
  for (const Eigen::Index i : inliers) {
    const Eigen::Vector3d d = rays.col(i);
    const double turn = std::atan2(d.dot(beside), d.dot(across)) / (2.0 * std::numbers::pi) + 0.5;
    seen[std::min<std::size_t>(static_cast<std::size_t>(turn * 36.0), 35)] = true;
  }
  return static_cast<double>(std::ranges::count(seen, true)) / 36.0;
}

GONIO_INLINE placed_sphere sphere_of(const Eigen::Vector3d& plane, const lens_camera& camera, double radius) {
  const double cosine = 1.0 / plane.norm(), sine = std::sqrt(1.0 - cosine * cosine);
  return {camera.position() + plane * (cosine * radius / sine), radius};
}

/// Returns the outline points at which the cosine of the light's angle of incidence is above 0.2.
GONIO_INLINE std::vector<Eigen::Index> well_lit(const Eigen::Matrix3Xd& rays,
                                                const std::vector<Eigen::Index>& candidates,
                                                const placed_sphere& sphere, const Eigen::Vector3d& camera,
                                                const surface_light& light) {
  constexpr double smallest_cosine = 0.2;
  const Eigen::Vector3d from = camera - sphere.centre;
  std::vector<Eigen::Index> lit;
  for (const Eigen::Index i : candidates) {
    // Take the ray's point nearest to the centre: a ray of the outline touches the sphere there.
    const Eigen::Vector3d towards = rays.col(i), off = from - towards * from.dot(towards), normal = off.normalized();
    const Eigen::Vector3d point = sphere.centre + sphere.radius * normal;
    if (normal.dot(light_at(light, point).towards) > smallest_cosine) lit.push_back(i);
  }
  return lit;
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE std::vector<Eigen::Vector2d> edge_points(const image& photograph) {
  const detail::contrast_image contrast = detail::contrast_of(photograph);
  std::vector<Eigen::Vector2d> points;
  // Scan all rows, and then all columns, from both ends.
  for (const bool is_row : {true, false})
    for (const bool is_backward : {false, true}) {
      const Eigen::Index lines = is_row ? contrast.rows : contrast.columns,
                         length = is_row ? contrast.columns : contrast.rows;
      const auto scan = [&](Eigen::Index line) {
        return detail::first_edge(length, contrast.threshold, [&](Eigen::Index i) {
          const Eigen::Index along = is_backward ? length - 1 - i : i;
          return is_row ? contrast.at(line, along) : contrast.at(along, line);
        });
      };
      detail::add_steep_edges(lines, scan, [&](double edge, double line) {
        const double along = is_backward ? static_cast<double>(length) - edge : edge;
        points.emplace_back(is_row ? along : line, is_row ? line : along);
      });
    }
  return points;
}

GONIO_INLINE fitted_outline fit_sphere(const std::vector<Eigen::Vector2d>& outline, const lens_camera& camera,
                                       double radius, const outline_options& options) {
  if (!(radius > 0.0 && std::isfinite(radius))) refuse("the sphere's radius must be positive");
  const Eigen::Index count = std::ssize(outline);
  if (count < 12) refuse({"no sphere is found: ", count, " edge points are too few for an outline"});
  Eigen::Matrix3Xd rays(3, count);
  for (Eigen::Index i = 0; i < count; ++i) rays.col(i) = camera.ray_through(outline[i].x(), outline[i].y()).towards;
  const double pixel_angle = camera.pixel_angle(), tolerance = options.inlier_distance * pixel_angle;
  std::optional<Eigen::Vector3d> plane = detail::consensus(rays, tolerance, pixel_angle, options);
  if (!plane) refuse("no sphere is found: no outline agrees with the edges of the image");
  // Fit a plane to all inliers and select the inliers again, repeatedly.
  std::vector<Eigen::Index> inliers;
  for (int round = 0; round < 20; ++round) {
    inliers = detail::within(detail::beyond_cone(rays, *plane), tolerance);
    if (3 * std::ssize(inliers) < count)
      refuse({"no sphere is found: ", inliers.size(), " of ", count,
              " edge points lie on one outline, expected at least ", (count + 2) / 3});
    if (const double covered = detail::covered_share(rays, inliers, *plane); covered < 0.25)
      refuse({"no sphere is found: the edge points of one outline cover ", std::lround(100.0 * covered),
              " % of it, expected at least 25 %"});
    if (options.light) {
      auto lit =
          detail::well_lit(rays, inliers, detail::sphere_of(*plane, camera, radius), camera.position(), *options.light);
      if (lit.size() >= 12) inliers = std::move(lit);
    }
    plane = detail::plane_of(rays, inliers);
    if (!detail::is_cone(*plane, pixel_angle))
      refuse("no sphere is found: the edges of the image do not form an outline");
  }
  const Eigen::VectorXd beyond = detail::beyond_cone(rays, *plane);
  double squares = 0.0;
  for (const Eigen::Index i : inliers) squares += std::pow(beyond[i] / pixel_angle, 2);
  return {detail::sphere_of(*plane, camera, radius), count, std::ssize(inliers),
          std::sqrt(squares / static_cast<double>(inliers.size()))};
}

GONIO_INLINE fitted_outline find_sphere(const image& photograph, const lens_camera& camera, double radius,
                                        const outline_options& options) {
  return fit_sphere(edge_points(photograph), camera, radius, options);
}

GONIO_INLINE fitted_outline fullest_outline(Eigen::Index photographs,
                                            const std::function<fitted_outline(Eigen::Index)>& find) {
  std::optional<fitted_outline> best;
  std::string why = "there is no photograph of the sphere";
  for (Eigen::Index i = 0; i < photographs; ++i) try {
      const fitted_outline found = find(i);
      if (!best || found.inliers > best->inliers) best = found;
    } catch (const error& refusal) {
      why = refusal.what();
    }
  if (!best) refuse(why);
  return *best;
}

GONIO_INLINE fitted_outline sphere_within(const outline_circle& circle, const lens_camera& camera, double radius) {
  if (!(circle.radius > 0.0 && std::isfinite(circle.radius) && std::isfinite(circle.column) &&
        std::isfinite(circle.row)))
    refuse("an outline needs a finite centre and a positive radius");
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 72; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / 72.0;
    points.emplace_back(circle.column + circle.radius * std::cos(turn), circle.row + circle.radius * std::sin(turn));
  }
  return fit_sphere(points, camera, radius, {.inlier_distance = std::max(1.0, 0.1 * circle.radius)});
}

}  // namespace gonio::capture
