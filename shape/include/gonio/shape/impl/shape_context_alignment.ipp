#pragma once
/// Bodies of shape/shape_context_alignment.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/shape_context.hpp>
#include <gonio/shape/shape_context_alignment.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace gonio::shape::detail {

GONIO_INLINE Eigen::VectorXd matched_points::squared_distances(const similarity_transform& pose) const {
  Eigen::VectorXd squares(from.cols());
  for (Eigen::Index i = 0; i < from.cols(); ++i) {
    const Eigen::Vector3d off = onto.col(i) - pose(from.col(i));
    squares[i] = off.squaredNorm();
  }
  return squares;
}

GONIO_INLINE std::pair<similarity_transform, Eigen::Index> robust_pose(const matched_points& points, Eigen::Index first,
                                                                       double tolerance) {
  constexpr double narrowing = 0.8;
  constexpr int most_steps = 200;
  similarity_transform pose = align(points.from.leftCols(first), points.onto.leftCols(first));
  Eigen::Index used = first;
  const Eigen::Index fewest = std::max<Eigen::Index>(3, points.from.cols() / 10);
  double limit = 3.0 * std::sqrt(points.squared_distances(pose).mean()) / narrowing;
  if (std::isinf(tolerance)) return {pose, used};
  for (int step = 0; step < most_steps; ++step) {
    limit = std::max(narrowing * limit, tolerance);
    Eigen::VectorXd weights = points.squared_distances(pose);
    Eigen::Index left = 0;
    for (double& weight : weights) {
      weight = std::max(1.0 - weight / (limit * limit), 0.0);
      left += weight > 0.0 ? 1 : 0;
    }
    if (left < fewest) break;
    used = left;
    const similarity_transform next = align(points.from, points.onto, alignment_kind::rigid, weights);
    double moved = 0.0;
    for (Eigen::Index i = 0; i < points.from.cols(); ++i) {
      const Eigen::Vector3d step_of_point = next(points.from.col(i)) - pose(points.from.col(i));
      moved = std::max(moved, step_of_point.norm());
    }
    pose = next;
    if (limit == tolerance && moved <= 1e-6 * tolerance) break;
  }
  return {pose, used};
}

/// Returns the vertices that belong to a triangle.
[[nodiscard]] GONIO_INLINE point_columns surface_vertices(const triangle_mesh& mesh) {
  std::vector<bool> in_use(mesh.vertices.cols(), false);
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t)
    for (Eigen::Index corner = 0; corner < 3; ++corner) in_use[mesh.triangles(corner, t)] = true;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index v = 0; v < std::ssize(in_use); ++v)
    if (in_use[v]) kept.push_back(v);
  return chosen_columns(mesh.vertices, kept);
}

/// Returns the mean distance of posed points to the points of a tree.
[[nodiscard]] GONIO_INLINE double mean_distance(const similarity_transform& pose, const point_columns& points,
                                                const point_tree& tree, thread_count threads) {
  const auto add = [&](double& sum, block some) {
    for (Eigen::Index i = some.begin; i < some.end; ++i) sum += std::sqrt(tree.squared_distance(pose(points.col(i))));
  };
  return sum_over_blocks(points.cols(), 256, 0.0, add, threads) / static_cast<double>(points.cols());
}

struct described_points {
  shape_descriptors descriptors;
  point_columns positions;
};

[[nodiscard]] GONIO_INLINE described_points described(const triangle_mesh& mesh,
                                                      const shape_context_alignment_options& options,
                                                      thread_count threads) {
  shape_descriptors found = describe(mesh, spread_vertices(mesh, options.points), options.context, threads);
  point_columns positions = chosen_columns(mesh.vertices, found.vertex);
  return {std::move(found), std::move(positions)};
}

GONIO_INLINE void require_points(const shape_descriptors& descriptors, const char* what) {
  if (descriptors.vertex.size() < 3)
    refuse({"a ", what, " to be aligned by shape contexts has ", descriptors.vertex.size(),
            " points that can be described, expected at least three: are all normals along the vertical axis?"});
}

}  // namespace gonio::shape::detail

namespace gonio::shape {

struct shape_context_matcher::described_model {
  described_model(const triangle_mesh& mesh, detail::described_points some)
      : points(std::move(some)), vertices(detail::surface_vertices(mesh)), tree(vertices) {}

  detail::described_points points;
  point_columns vertices;
  detail::point_tree tree;
};

GONIO_INLINE shape_context_matcher::shape_context_matcher(const triangle_mesh& model,
                                                          const shape_context_alignment_options& options,
                                                          thread_count threads)
    : options_(options) {
  if (options.points < 3) refuse({"an alignment by shape contexts needs at least three points, not ", options.points});
  if (!(options.significant > 0.0 && options.significant <= 1.0))
    refuse({"the share of significant matches must be above 0 and at most 1, not ", options.significant});
  if (!(options.tolerance > 0.0)) refuse({"the tolerance of matches must be positive, not ", options.tolerance});
  model_ = std::make_shared<const described_model>(model, detail::described(model, options_, threads));
  detail::require_points(model_->points.descriptors, "model");
}

GONIO_INLINE pre_alignment shape_context_matcher::align(const triangle_mesh& scan, thread_count threads) const {
  const detail::described_points found = detail::described(scan, options_, threads);
  detail::require_points(found.descriptors, "scan");
  const std::vector<shape_match> matches = match(found.descriptors, model_->points.descriptors, threads);
  detail::matched_points pairs{point_columns(3, std::ssize(matches)), {}};
  pairs.onto.resizeLike(pairs.from);
  for (Eigen::Index i = 0; i < std::ssize(matches); ++i) {
    pairs.from.col(i) = found.positions.col(matches[i].from);
    pairs.onto.col(i) = model_->points.positions.col(matches[i].onto);
  }
  const auto count = static_cast<double>(matches.size());
  const auto first = std::max<Eigen::Index>(3, std::lround(options_.significant * count));
  const auto [pose, used] = detail::robust_pose(pairs, first, options_.tolerance);
  const point_columns scanned = detail::surface_vertices(scan);
  const detail::point_tree tree(scanned);
  return {pose, detail::mean_distance(pose.inverse(), model_->vertices, tree, threads),
          detail::mean_distance(pose, scanned, model_->tree, threads), used};
}

GONIO_INLINE pre_alignment align_by_shape_context(const triangle_mesh& scan, const triangle_mesh& model,
                                                  const shape_context_alignment_options& options,
                                                  thread_count threads) {
  return shape_context_matcher(model, options, threads).align(scan, threads);
}

}  // namespace gonio::shape
