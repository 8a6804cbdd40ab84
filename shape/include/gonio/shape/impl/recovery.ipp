#pragma once
/// Bodies of shape/recovery.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/probability.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/correspondence.hpp>
#include <gonio/shape/fit_to_scan.hpp>
#include <gonio/shape/geodesic.hpp>
#include <gonio/shape/recovery.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace gonio::shape::detail {

/// Throws gonio::error if the fitted shape is too far from the mean.
GONIO_INLINE void require_of_family(const fit_to_scan_result& fit, const shape_model& model, double confidence) {
  const Eigen::Index weights = fit.weights().size();
  const double limit = chi_square_quantile(confidence, static_cast<double>(weights));
  if (fit.squared_distance() <= limit) return;
  refuse({"the scan does not fit the model: its Mahalanobis distance from the mean shape is ",
          std::sqrt(fit.squared_distance()), ", expected at most ", std::sqrt(limit), " with ", weights,
          " components of ", model.shapes(), " shapes"});
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE recovered_shape recover(const shape_model& model, const surface_index& scan,
                                     const similarity_transform& pose, const recovery_options& options,
                                     thread_count threads) {
  const fit_to_scan_result initial = fit_to_scan(model, scan, pose, options.coarse, threads);
  detail::require_of_family(initial, model, options.confidence);
  fit_to_scan_result fit = fit_to_scan(model, scan, initial.pose, options.fine, threads);
  triangle_mesh surface = model.mesh(fit.shape());
  return {std::move(surface), fit.correspondences, fit.pose, fit};
}

}  // namespace gonio::shape

namespace gonio::shape::detail {

/// Predicts every vertex from the known vertices nearest to it along the mean shape.
[[nodiscard]] GONIO_INLINE point_columns predict_locally(const shape_model& model, const triangle_mesh& mean,
                                                         const vertex_observations& known,
                                                         const algorithm_1_options& options, thread_count threads) {
  const truncated_svd solver{options.last_explained_variance};
  const std::vector<bool> marks = marks_of(known, model.vertices());
  std::vector<Eigen::Index> column_of(marks.size(), 0);  // the column of each known vertex in `known.positions`
  for (Eigen::Index i = 0; i < std::ssize(known.vertices); ++i) column_of[known.vertices[i]] = i;
  const auto is_known = [&](Eigen::Index vertex) { return bool{marks[vertex]}; };
  point_columns predicted(3, model.vertices());
  for_each_index(
      marks.size(), 32,
      [&](Eigen::Index vertex) {
        vertex_observations near{nearest_along_surface(mean, model.topology(), vertex, is_known, options.neighbours),
                                 {}};
        std::vector<Eigen::Index> columns;
        for (const Eigen::Index neighbour : near.vertices) columns.push_back(column_of[neighbour]);
        near.positions = chosen_columns(known.positions, columns);
        near.normals = chosen_columns(known.normals, columns);
        near.tangential = known.tangential;
        predicted.col(vertex) = fit_shape(model.basis(), solver, near, {1}).vertex(vertex);
      },
      threads);
  return predicted;
}

GONIO_INLINE double explained_variance_in(int round, const algorithm_1_options& options) {
  const double progress = options.rounds > 1 ? static_cast<double>(round) / (options.rounds - 1) : 1.0;
  return std::lerp(options.first_explained_variance, options.last_explained_variance, std::min(progress, 1.0));
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE recovered_shape recover_algorithm_1(const shape_model& model, const surface_index& scan,
                                                 const similarity_transform& pose, const algorithm_1_options& options,
                                                 thread_count threads) {
  fit_to_scan_result initial = fit_to_scan(model, scan, pose, options.coarse, threads);
  detail::require_of_family(initial, model, options.confidence);
  return recover_algorithm_1(model, scan, std::move(initial), options, threads);
}

GONIO_INLINE recovered_shape recover_algorithm_1(const shape_model& model, const surface_index& scan,
                                                 fit_to_scan_result initial, const algorithm_1_options& options,
                                                 thread_count threads) {
  const triangle_mesh mean = model.mean();
  posed_scan posed{scan, initial.pose};
  triangle_mesh shape = model.mesh(initial.shape());
  vertex_observations known = closest_correspondences(posed, shape, options.correspondence, threads);
  // Aligns the shape with the mean and moves the scan by the same transform, predicts all vertices, and finds them on
  // the scan. Returns the change of the shape, root mean square in mm.
  const auto improve = [&](auto&& predict) {
    if (options.aligns) {
      point_columns whole = shape.vertices;
      for (Eigen::Index i = 0; i < std::ssize(known.vertices); ++i)
        whole.col(known.vertices[i]) = known.positions.col(i);
      const similarity_transform step = align(whole, mean.vertices);
      posed.pose = step * posed.pose;
      known.positions = step(known.positions);
      known.normals = similarity_transform{1.0, step.rotation}(known.normals);
    }
    point_columns predicted = predict();
    const double change = (predicted - shape.vertices).norm() / std::sqrt(static_cast<double>(model.vertices()));
    shape.vertices = std::move(predicted);
    known = closest_correspondences(posed, shape, options.correspondence, threads);
    require_shown(known, model);
    return change;
  };
  for (int round = 0; round < options.most_rounds; ++round) {
    const truncated_svd solver{detail::explained_variance_in(round, options)};
    const double change = improve([&] { return fit_shape(model.basis(), solver, known, threads).vertices(); });
    if (round + 1 >= options.rounds && change <= options.tolerance) break;
  }
  for (int round = 0; round < options.local_rounds; ++round)
    improve([&] { return detail::predict_locally(model, mean, known, options, threads); });
  return {std::move(shape), std::move(known), posed.pose, std::move(initial)};
}

}  // namespace gonio::shape
