#pragma once
/// Bodies of shape/shape_context_alignment.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/shape_context.hpp>
#include <gonio/shape/shape_context_alignment.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gonio::detail {

GONIO_INLINE Eigen::VectorXd matched_points::squared_distances(const similarity_transform& pose) const {
  return (pose(from) - onto).colwise().squaredNorm().transpose();
}

GONIO_INLINE std::pair<similarity_transform, std::size_t> robust_pose(const matched_points& points, Eigen::Index first,
                                                                      double tolerance) {
  constexpr double narrowing = 0.8;
  constexpr int most_steps = 200;
  similarity_transform pose = align(points.from.leftCols(first), points.onto.leftCols(first));
  auto used = static_cast<std::size_t>(first);
  const Eigen::Index fewest = std::max<Eigen::Index>(3, points.from.cols() / 10);
  double limit = 3.0 * std::sqrt(points.squared_distances(pose).mean()) / narrowing;
  if (std::isinf(tolerance)) return {pose, used};
  for (int step = 0; step < most_steps; ++step) {
    limit = std::max(narrowing * limit, tolerance);
    const Eigen::VectorXd weights = (1.0 - points.squared_distances(pose).array() / (limit * limit)).max(0.0).matrix();
    const Eigen::Index left = (weights.array() > 0.0).count();
    if (left < fewest) break;
    used = static_cast<std::size_t>(left);
    const similarity_transform next = align(points.from, points.onto, alignment_kind::rigid, weights);
    const double moved = (next(points.from) - pose(points.from)).colwise().norm().maxCoeff();
    pose = next;
    if (limit == tolerance && moved <= 1e-6 * tolerance) break;
  }
  return {pose, used};
}

GONIO_INLINE point_columns surface_vertices(const triangle_mesh& mesh) {
  std::vector<bool> in_use(static_cast<std::size_t>(mesh.vertices.cols()), false);
  for (const int vertex : mesh.triangles.reshaped()) in_use[static_cast<std::size_t>(vertex)] = true;
  std::vector<Eigen::Index> kept;
  for (std::size_t v = 0; v < in_use.size(); ++v)
    if (in_use[v]) kept.push_back(static_cast<Eigen::Index>(v));
  return mesh.vertices(Eigen::all, kept);
}

GONIO_INLINE double mean_distance(const similarity_transform& pose, const point_columns& points, const point_tree& tree,
                                  thread_count threads) {
  const auto add = [&](double& sum, block some) {
    for (auto i = static_cast<Eigen::Index>(some.begin); i < static_cast<Eigen::Index>(some.end); ++i)
      sum += std::sqrt(tree.squared_distance(pose(points.col(i))));
  };
  return sum_over_blocks(static_cast<std::size_t>(points.cols()), 256, 0.0, add, threads) /
         static_cast<double>(points.cols());
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE shape_context_matcher::shape_context_matcher(const triangle_mesh& model,
                                                          const shape_context_alignment_options& options,
                                                          thread_count threads)
    : options_(options) {
  if (options.points < 3)
    throw error("an alignment by shape contexts needs at least three points, not " + std::to_string(options.points));
  if (!(options.significant > 0.0 && options.significant <= 1.0))
    throw error("the share of significant matches must be above 0 and at most 1, not " +
                std::to_string(options.significant));
  if (!(options.tolerance > 0.0))
    throw error("the tolerance of matches must be positive, not " + std::to_string(options.tolerance));
  model_ = std::make_shared<const described_model>(model, described(model, threads));
  require_points(model_->points.descriptors, "model");
}

GONIO_INLINE pre_alignment shape_context_matcher::align(const triangle_mesh& scan, thread_count threads) const {
  const described_points found = described(scan, threads);
  require_points(found.descriptors, "scan");
  const std::vector<shape_match> matches = match(found.descriptors, model_->points.descriptors, threads);
  detail::matched_points pairs{point_columns(3, static_cast<Eigen::Index>(matches.size())), {}};
  pairs.onto.resizeLike(pairs.from);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    pairs.from.col(static_cast<Eigen::Index>(i)) = found.places.col(matches[i].from);
    pairs.onto.col(static_cast<Eigen::Index>(i)) = model_->points.places.col(matches[i].onto);
  }
  const auto count = static_cast<double>(matches.size());
  const auto first = std::max<Eigen::Index>(3, std::lround(options_.significant * count));
  const auto [pose, used] = detail::robust_pose(pairs, first, options_.tolerance);
  const point_columns scanned = detail::surface_vertices(scan);
  const detail::point_tree tree(scanned);
  return {pose, detail::mean_distance(pose.inverse(), model_->vertices, tree, threads),
          detail::mean_distance(pose, scanned, model_->tree, threads), used};
}

GONIO_INLINE shape_context_matcher::described_points shape_context_matcher::described(const triangle_mesh& mesh,
                                                                                      thread_count threads) const {
  shape_descriptors found = describe(mesh, spread_vertices(mesh, options_.points), options_.context, threads);
  point_columns places = mesh.vertices(Eigen::all, found.vertex);
  return {std::move(found), std::move(places)};
}

GONIO_INLINE void shape_context_matcher::require_points(const shape_descriptors& descriptors, const char* what) {
  if (descriptors.vertex.size() < 3)
    throw error("a " + std::string(what) + " to be aligned by shape contexts has " +
                std::to_string(descriptors.vertex.size()) +
                " points that can be described, not three: are all normals along the vertical axis?");
}

}  // namespace gonio
