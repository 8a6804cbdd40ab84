#pragma once
/// Bodies of shape/registration.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/probability.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/correspondence.hpp>
#include <gonio/shape/fit_to_scan.hpp>
#include <gonio/shape/registration.hpp>
#include <gonio/shape/surface_noise.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace gonio::shape {

GONIO_INLINE double smallest_angle_percentile(const triangle_mesh& mesh, double share) {
  std::vector<double> smallest;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    smallest.push_back(degrees(std::min({mesh.angle(t, 0), mesh.angle(t, 1), mesh.angle(t, 2)})));
  }
  return quantile(smallest, share);
}

}  // namespace gonio::shape

namespace gonio::shape::detail {

/// Returns the intersections of the scan with lines along the smoothed normals of a shape.
[[nodiscard]] GONIO_INLINE vertex_observations correspondences_along_normals(const posed_scan& scan,
                                                                             const shape_model& model,
                                                                             const triangle_mesh& shape,
                                                                             const registration_options& options,
                                                                             thread_count threads) {
  const point_columns normals = unit_columns(averaged_over_neighbours(model.topology(), vertex_normals(shape)));
  const Eigen::Index count = shape.vertices.cols();
  point_columns positions(3, shape.vertices.cols());
  std::vector<char> shown(count, 0);
  for_each_index(
      count, 128,
      [&](Eigen::Index v) {
        if (!(normals.col(v).norm() > 0.0)) return;
        const auto found = scan.along(shape.vertices.col(v), normals.col(v), options.reach);
        if (!found || found->on_border) return;
        if (scan.normal(*found).dot(normals.col(v)) < options.fit.correspondence.normal_agreement) return;
        positions.col(v) = found->position;
        shown[v] = 1;
      },
      threads);
  return shown_vertices(positions, normals, shown, options.fit.correspondence.tangential);
}

/// Returns a message for the first test that fails; empty if all pass.
[[nodiscard]] GONIO_INLINE std::string refusal_of(const registration& found, const fit_to_scan_result& fit,
                                                  const registration_options& options) {
  const auto weights = static_cast<double>(fit.weights().size());
  const double limit = chi_square_quantile(options.confidence, weights);
  if (found.squared_distance > limit)
    return "the Mahalanobis distance of its weights is " + std::to_string(std::sqrt(found.squared_distance)) +
           ", expected at most " + std::to_string(std::sqrt(limit));
  if (found.missing > options.most_missing)
    return "it does not show " + std::to_string(100.0 * found.missing) + " % of the vertices, expected at most " +
           std::to_string(100.0 * options.most_missing);
  if (found.angle < options.least_angle)
    return "a fifth of its triangles have an angle below " + std::to_string(found.angle) +
           " degrees, expected at least " + std::to_string(options.least_angle);
  if (found.normal_agreement < options.least_normal_agreement)
    return "its normals agree with the fit's normals to " + std::to_string(found.normal_agreement) +
           " on average, expected at least " + std::to_string(options.least_normal_agreement);
  return {};
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE registration register_scan(const shape_model& model, const surface_index& scan,
                                        const similarity_transform& pose, const registration_options& options,
                                        thread_count threads) {
  const fit_to_scan_result fit = fit_to_scan(model, scan, pose, options.fit, threads);
  const point_columns fitted = fit.shape();
  registration found;
  found.vertices = fitted;
  found.pose = fit.pose;
  found.squared_distance = fit.squared_distance();
  const double tolerance = options.tolerance * std::sqrt(static_cast<double>(model.vertices()));
  for (int round = 0; round < options.rounds; ++round) {
    const triangle_mesh smoothed = model.mesh(averaged_over_neighbours(model.topology(), found.vertices));
    vertex_observations correspondences =
        detail::correspondences_along_normals({scan, found.pose}, model, smoothed, options, threads);
    require_shown(correspondences, model);
    if (options.realigns) {
      const similarity_transform step =
          align(correspondences.positions, chosen_columns(fitted, correspondences.vertices));
      found.pose = step * found.pose;
      correspondences.positions = step(correspondences.positions);
    }
    point_columns next = smoothed.vertices;
    for (Eigen::Index i = 0; i < std::ssize(correspondences.vertices); ++i)
      next.col(correspondences.vertices[i]) = correspondences.positions.col(i);
    found.missing = 1.0 - static_cast<double>(correspondences.vertices.size()) / static_cast<double>(model.vertices());
    const double change = (next - found.vertices).norm();
    found.vertices = std::move(next);
    if (change <= tolerance) break;
  }
  const triangle_mesh registered = model.mesh(found.vertices);
  found.angle = smallest_angle_percentile(registered, 0.2);
  const point_columns normals = vertex_normals(registered), of_fit = vertex_normals(model.mesh(fitted));
  for (Eigen::Index v = 0; v < normals.cols(); ++v)
    found.normal_agreement += normals.col(v).dot(of_fit.col(v)) / static_cast<double>(normals.cols());
  found.refusal = detail::refusal_of(found, fit, options);
  return found;
}

}  // namespace gonio::shape
