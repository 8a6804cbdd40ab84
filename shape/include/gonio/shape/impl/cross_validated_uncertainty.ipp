#pragma once
/// Bodies of shape/cross_validated_uncertainty.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/shape/cross_validated_uncertainty.hpp>
#include <gonio/shape/mesh_part.hpp>
#include <gonio/shape/recovery.hpp>
#include <gonio/shape/shape_context_alignment.hpp>
#include <gonio/shape/surface_noise.hpp>
#include <gonio/solve/dense.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace gonio::shape::detail {

inline constexpr Eigen::Index least_trials = 10;

GONIO_INLINE void require_trials(const shape_model& model, const cross_validation_options& options) {
  const Eigen::Index shapes = model.shapes();
  if (options.trials < least_trials || options.trials > shapes)
    refuse({"from ", least_trials, " to ", shapes, " shapes can be left out, not ", options.trials});
  if (options.parts < 2 || shapes < options.parts || shapes - (shapes + options.parts - 1) / options.parts < 2)
    refuse({shapes, " shapes cannot be left out in ", options.parts,
            " parts: expected at least 2 parts that each leave at least 2 shapes"});
}

/// Returns the median noise of a scan, mm.
[[nodiscard]] GONIO_INLINE double noise_of(const surface_index& scan) {
  Eigen::RowVectorXd variances = noise_variances(scan.mesh(), scan.topology());
  return std::sqrt(upper_median(std::span(variances.data(), variances.size())));
}

/// Returns a model for each part, learned from the other shapes.
[[nodiscard]] GONIO_INLINE std::vector<shape_model> models_without_parts(const shape_model& model,
                                                                         const std::vector<point_columns>& shapes,
                                                                         Eigen::Index parts, thread_count threads) {
  std::vector<shape_model> models;
  for (Eigen::Index part = 0; part < parts; ++part) {
    std::vector<point_columns> others;
    std::vector<std::string> names;
    for (Eigen::Index i = 0; i < std::ssize(shapes); ++i) {
      if (i % parts == part) continue;
      others.push_back(shapes[i]);
      names.push_back(model.basis().names()[i]);
    }
    models.push_back(learn_shape_model(others, std::move(names), model.triangles(), threads));
  }
  return models;
}

/// Returns the vertex errors of a shape that a model of other shapes recovers; nothing if the recovery fails.
[[nodiscard]] GONIO_INLINE std::optional<point_columns> error_of(const shape_model& others, const point_columns& shape,
                                                                 const std::vector<bool>& shown, double noise,
                                                                 std::uint64_t seed, const recovery_options& options) {
  triangle_mesh noisy = others.mesh(shape);
  const point_columns normals = vertex_normals(noisy);
  std::mt19937_64 generator(seed);
  // The noise is uniform: only its variance matters, and normal random numbers differ between standard libraries.
  for (Eigen::Index v = 0; v < normals.cols(); ++v) {
    const double centred = uniform_number(generator) - 0.5;
    noisy.vertices.col(v) += noise * std::sqrt(12.0) * centred * normals.col(v);
  }
  try {
    const triangle_mesh scan = part_of(noisy, shown);
    constexpr thread_count one{1};
    const similarity_transform pose = align_by_shape_context(scan, others.mean(), {}, one).transform;
    recovery_options of_the_family = options;  // accepts rare shapes, too: their errors belong to the measurement
    of_the_family.confidence = 1.0 - 1e-12;
    const recovered_shape found = recover(others, surface_index(scan), pose, of_the_family, one);
    return found.pose.inverse()(found.surface.vertices) - shape;
  } catch (const error&) {
    return {};
  }
}

[[nodiscard]] GONIO_INLINE std::vector<point_columns> errors_of_trials(const shape_model& model, double noise,
                                                                       const std::vector<bool>& shown,
                                                                       const cross_validation_options& options,
                                                                       thread_count threads) {
  std::vector<point_columns> shapes;
  for (Eigen::Index shape = 0; shape < model.shapes(); ++shape)
    shapes.push_back(shape_of(model.basis(), model.basis().weights_of(shape)));
  const std::vector<shape_model> models = models_without_parts(model, shapes, options.parts, threads);
  std::vector<std::optional<point_columns>> found(options.trials);
  for_each_block(
      options.trials, 1,
      [&](block trial) {
        const Eigen::Index left_out = trial.begin * shapes.size() / options.trials;
        found[trial.begin] = error_of(models[left_out % options.parts], shapes[left_out], shown, noise,
                                      options.seed + left_out, options.recovery);
      },
      threads);
  std::vector<point_columns> errors;
  for (auto& one : found)
    if (one) errors.push_back(std::move(*one));
  return errors;
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

GONIO_INLINE cross_validated_uncertainty::cross_validated_uncertainty(const shape_model& model,
                                                                      const surface_index& scan,
                                                                      const recovered_shape& recovered,
                                                                      const cross_validation_options& options,
                                                                      thread_count threads) {
  detail::require_trials(model, options);
  const std::vector<point_columns> errors = detail::errors_of_trials(
      model, detail::noise_of(scan), marks_of(recovered.known, model.vertices()), options, threads);
  if (errors.size() < detail::least_trials)
    refuse({"of ", options.trials, " left-out shapes, ", errors.size(), " were recovered, expected at least ",
            detail::least_trials, ": the scan shows too little"});
  trials_ = errors.size();
  covariances_.reserve(model.vertices());
  for (Eigen::Index vertex = 0; vertex < model.vertices(); ++vertex) add_vertex(errors, vertex);
  std::ranges::sort(squared_distances_);
}

GONIO_INLINE double cross_validated_uncertainty::squared_radius(double share) const {
  if (!(share > 0.0 && share < 1.0)) refuse({"a share of vertices must be above 0 and below 1, not ", share});
  const double of_measured = std::min(share * (1.0 + 1.0 / static_cast<double>(trials_)), 1.0);
  const double rank = std::ceil(of_measured * static_cast<double>(squared_distances_.size()));
  return squared_distances_[static_cast<Eigen::Index>(rank) - 1];
}

GONIO_INLINE void cross_validated_uncertainty::add_vertex(const std::vector<point_columns>& errors,
                                                          Eigen::Index vertex) {
  const auto n = static_cast<double>(errors.size());
  Eigen::MatrixXd off(3, std::ssize(errors));
  for (Eigen::Index trial = 0; trial < off.cols(); ++trial) off.col(trial) = errors[trial].col(vertex);
  const Eigen::MatrixXd sum = product_with_transpose(off), whitened = cholesky(sum).solve_lower(off);
  covariances_.emplace_back(sum / n);
  for (Eigen::Index trial = 0; trial < off.cols(); ++trial) {
    const double with_itself = whitened.col(trial).squaredNorm();
    // The squared distance under the covariance of the other trials, (sum - e e') / (n - 1), by the Sherman-Morrison
    // formula.
    squared_distances_.push_back((n - 1.0) * with_itself / std::max(1.0 - with_itself, 1e-12));
  }
}

}  // namespace gonio::shape
