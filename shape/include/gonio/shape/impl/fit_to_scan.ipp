#pragma once
/// Bodies of shape/fit_to_scan.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/basis_equations.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/correspondence.hpp>
#include <gonio/shape/fit_to_scan.hpp>
#include <gonio/shape/shape_model.hpp>
#include <gonio/shape/shape_uncertainty.hpp>
#include <gonio/shape/shape_with_motion.hpp>
#include <gonio/shape/surface_noise.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace gonio::shape {

GONIO_INLINE point_columns fit_to_scan_result::shape() const { return shape_of(functions.shape(), weights()); }

GONIO_INLINE Eigen::VectorXd fit_to_scan_result::weights() const { return functions.split(all_weights).shape; }

GONIO_INLINE double fit_to_scan_result::squared_distance() const {
  return squared_mahalanobis(functions.shape(), weights());
}

GONIO_INLINE shape_uncertainty fit_to_scan_result::uncertainty() const {
  return {functions, all_weights, correspondences, solver};
}

GONIO_INLINE void require_shown(const vertex_observations& correspondences, const shape_model& model) {
  constexpr Eigen::Index least = 10;
  if (correspondences.vertices.size() < least)
    refuse({"the scan shows ", correspondences.vertices.size(), " of the model's ", model.vertices(),
            " vertices, expected at least ", least, ": is its pose right?"});
}

}  // namespace gonio::shape

namespace gonio::shape::detail {

GONIO_INLINE Eigen::VectorXd inlier_weights(const vertex_observations& correspondences, const point_columns& shape,
                                            double position_error) {
  std::vector<double> distances;
  distances.reserve(correspondences.vertices.size());
  for (const Eigen::Index vertex : correspondences.vertices) {
    const Eigen::Vector3d off = correspondences.positions.col(std::ssize(distances)) - shape.col(vertex);
    distances.push_back(off.norm());
  }
  const double usual = 3.0 * std::max(position_error, upper_median(std::vector(distances)));
  Eigen::VectorXd weights(correspondences.positions.cols());
  for (Eigen::Index i = 0; i < std::ssize(distances); ++i) {
    const double ratio = distances[i] / usual, root = 1.0 + ratio * ratio;
    weights[i] = 1.0 / (root * root);
  }
  return weights;
}

/// Returns the weights of a scan's vertices, which fall with the ratio of noise to position error.
[[nodiscard]] GONIO_INLINE Eigen::RowVectorXd surface_weights(const surface_index& scan, double position_error) {
  Eigen::RowVectorXd weights = noise_variances(scan.mesh(), scan.topology());
  for (double& noise : weights) noise = 1.0 / (1.0 + noise / (position_error * position_error));
  return weights;
}

[[nodiscard]] GONIO_INLINE vertex_observations weighted_correspondences(const posed_scan& scan,
                                                                        const triangle_mesh& shape,
                                                                        const fit_to_scan_options& options,
                                                                        thread_count threads) {
  vertex_observations correspondences = closest_correspondences(scan, shape, options.correspondence, threads);
  if (!options.robust || correspondences.vertices.empty()) return correspondences;
  const Eigen::VectorXd weights = inlier_weights(correspondences, shape.vertices, options.position_error);
  for (Eigen::Index i = 0; i < weights.size(); ++i) correspondences.weights[i] *= weights[i];
  return correspondences;
}

/// Returns the weights of all functions for the observed positions. If the pose is held, the motion's weights are 0.
[[nodiscard]] GONIO_INLINE Eigen::VectorXd fitted_weights(const shape_with_motion& functions,
                                                          const vertex_observations& correspondences,
                                                          const tikhonov& solver, bool holds_pose,
                                                          thread_count threads) {
  const located_samples located = locate_vertices(functions.cells(), correspondences);
  if (!holds_pose) return basis_equations(functions, located, threads).solve(solver).weights.col(0);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(functions.size());
  weights.head(functions.shape().size()) =
      basis_equations(functions.shape(), located, threads).solve(solver).weights.col(0);
  return weights;
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE fit_to_scan_result fit_to_scan(const shape_model& model, const surface_index& scan,
                                            const similarity_transform& pose, const fit_to_scan_options& options,
                                            thread_count threads) {
  const shape_model part = model.truncated_to_variance(options.explained_variance);
  const tikhonov solver{static_cast<double>(part.shapes()) * options.position_error * options.position_error};
  triangle_mesh shape = part.mean();
  const double tolerance = options.tolerance * std::sqrt(static_cast<double>(part.vertices()));
  posed_scan posed{scan, pose, detail::surface_weights(scan, options.position_error)};
  for (int iteration = 1;; ++iteration) {
    vertex_observations correspondences = detail::weighted_correspondences(posed, shape, options, threads);
    require_shown(correspondences, part);
    shape_with_motion functions(part.basis(), shape.vertices);
    Eigen::VectorXd weights = detail::fitted_weights(functions, correspondences, solver, options.holds_pose, threads);
    const auto [shape_weights, motion] = functions.split(weights);
    // Move the scan, not the shape.
    posed.pose = motion.inverse() * posed.pose;
    point_columns vertices = shape_of(part.basis(), shape_weights);
    const double change = (vertices - shape.vertices).norm();
    shape.vertices = std::move(vertices);
    if (change > tolerance && iteration < options.most_iterations) continue;
    correspondences = detail::weighted_correspondences(posed, shape, options, threads);
    return {posed.pose, std::move(functions), std::move(weights), std::move(correspondences), solver, iteration};
  }
}

}  // namespace gonio::shape
