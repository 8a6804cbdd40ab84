#pragma once
/// Bodies of shape/fit_to_scan.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/shape/correspondence.hpp>
#include <gonio/shape/fit_to_scan.hpp>
#include <gonio/shape/shape_model.hpp>
#include <gonio/shape/shape_uncertainty.hpp>
#include <gonio/shape/surface_noise.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE point_columns fit_to_scan_result::shape() const {
  Eigen::VectorXd still = fit.weights();
  still.tail<motions>().setZero();
  return shape_of(fit.functions(), still);
}

GONIO_INLINE void require_shown(const known_vertices& places, const shape_model& model) {
  constexpr std::size_t least = 10;
  if (places.vertices.size() < least)
    throw error("the scan shows " + std::to_string(places.vertices.size()) + " of the model's " +
                std::to_string(model.vertices()) + " vertices, expected at least " + std::to_string(least) +
                ": is its pose right?");
}

}  // namespace gonio

namespace gonio::detail {

GONIO_INLINE Eigen::VectorXd trust_in(const known_vertices& places, const point_columns& shape, double misplacement) {
  const Eigen::VectorXd distances =
      (places.positions - shape(Eigen::all, places.vertices)).colwise().norm().transpose();
  std::vector<double> sorted(distances.begin(), distances.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  const double usual = 3.0 * std::max(misplacement, *middle);
  return (1.0 + (distances.array() / usual).square()).square().inverse();
}

GONIO_INLINE Eigen::RowVectorXd trust_in_surface(const surface_index& scan, double misplacement) {
  const Eigen::RowVectorXd noise = noise_variances(scan.mesh(), scan.topology());
  return (1.0 + noise.array() / (misplacement * misplacement)).inverse();
}

GONIO_INLINE similarity_transform motion_of(const Eigen::VectorXd& weights, const point_columns& shape,
                                            double freedom) {
  const Eigen::Vector3d centroid = shape.rowwise().mean();
  const Eigen::Vector3d turn = freedom * weights.tail<6>().head<3>(), shift = freedom * weights.tail<3>();
  const double angle = turn.norm();
  const Eigen::Matrix3d rotation = angle > 0.0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix()
                                               : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  return {1.0, rotation, centroid + shift - rotation * centroid};
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE fit_to_scan_result fit_to_scan(const shape_model& model, const surface_index& scan,
                                            const similarity_transform& pose, const fit_to_scan_options& options,
                                            thread_count threads) {
  constexpr double freedom = 1e3;
  const shape_model part = model.explaining(options.explained_variance);
  const tikhonov solver{static_cast<double>(part.shapes()) * options.misplacement * options.misplacement};
  const auto k = static_cast<Eigen::Index>(part.basis().size());
  triangle_mesh shape = part.mean();
  const double tolerance = options.tolerance * std::sqrt(static_cast<double>(part.vertices()));
  posed_scan posed{scan, pose, detail::trust_in_surface(scan, options.misplacement)};
  for (int iteration = 1;; ++iteration) {
    known_vertices places = closest_places(posed, shape, options.correspondence, threads);
    require_shown(places, part);
    if (options.robust) places.trust.array() *= detail::trust_in(places, shape.vertices, options.misplacement).array();
    fitted_shape fit = decomposition{with_motion(part.basis(), shape.vertices, freedom), solver, threads}.fit(places);
    // The scan moves, not the shape.
    posed.pose = detail::motion_of(fit.weights(), shape.vertices, freedom).inverse() * posed.pose;
    point_columns vertices = shape_of(part.basis(), fit.weights().head(k));
    const double change = (vertices - shape.vertices).norm();
    shape.vertices = std::move(vertices);
    if (change > tolerance && iteration < options.most_iterations) continue;
    places = closest_places(posed, shape, options.correspondence, threads);
    if (options.robust) places.trust.array() *= detail::trust_in(places, shape.vertices, options.misplacement).array();
    return {posed.pose, std::move(fit), std::move(places), solver, iteration};
  }
}

}  // namespace gonio
