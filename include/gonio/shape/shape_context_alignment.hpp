#pragma once
/// Brings a scan in any pose near a model, by points that look alike: the alignment from which a fit can start.
/// "Anatomically correct surface recovery" (Nielsen's doctoral thesis, DTU 2016, contribution C.V), section 2.

#include <gonio/shape/alignment.hpp>
#include <gonio/shape/shape_context.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// How a scan is aligned by shape contexts. Lengths are in millimetres by default.
struct shape_context_alignment_options {
  shape_context_options context;
  Eigen::Index points = 300;       ///< described on each surface
  double significant = 1.0 / 3.0;  ///< share of the matches, the most alike, that make the first pose: the paper's 100
  double tolerance = 5.0;          ///< matches that end farther apart do not count; infinity leaves the first pose
};

/// A pose that was found, and how well it fits.
struct pre_alignment {
  similarity_transform transform;  ///< from the scan's to the model's coordinates; its scale is 1
  double mean_distance = 0.0;  ///< of the model's vertices to the closest scanned ones; the paper rejects above 5 mm
  double mean_scan_distance = 0.0;  ///< of the scanned vertices to the model's closest: holes do not add to this one
  std::size_t matches = 0;          ///< that determined the pose
};

namespace detail {

/// Corresponded points in the order of their matches.
struct matched_points {
  point_columns from, onto;

  [[nodiscard]] Eigen::VectorXd squared_distances(const similarity_transform& pose) const {
    return (pose(from) - onto).colwise().squaredNorm().transpose();
  }
};

/// The paper's least squares over the first matches, then weighted ones over all matches: a weight falls with the
/// square of the distance and ends at a limit, which narrows from three times the root mean square until the tolerance,
/// and then stays until the pose does. Narrowing ends early where less than a tenth of the matches would be left. It is
/// an M-estimate with Epanechnikov's weights, approached from far as by Blake and Zisserman's graduated non-convexity.
[[nodiscard]] inline std::pair<similarity_transform, std::size_t> robust_pose(const matched_points& points,
                                                                              Eigen::Index first, double tolerance) {
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

/// The vertices that triangles have.
[[nodiscard]] inline point_columns surface_vertices(const triangle_mesh& mesh) {
  std::vector<bool> in_use(static_cast<std::size_t>(mesh.vertices.cols()), false);
  for (const int vertex : mesh.triangles.reshaped()) in_use[static_cast<std::size_t>(vertex)] = true;
  std::vector<Eigen::Index> kept;
  for (std::size_t v = 0; v < in_use.size(); ++v)
    if (in_use[v]) kept.push_back(static_cast<Eigen::Index>(v));
  return mesh.vertices(Eigen::all, kept);
}

/// Of points in a pose to those of a tree.
[[nodiscard]] inline double mean_distance(const similarity_transform& pose, const point_columns& points,
                                          const point_tree& tree, thread_count threads) {
  const auto add = [&](double& sum, block some) {
    for (auto i = static_cast<Eigen::Index>(some.begin); i < static_cast<Eigen::Index>(some.end); ++i)
      sum += std::sqrt(tree.squared_distance(pose(points.col(i))));
  };
  return sum_over_blocks(static_cast<std::size_t>(points.cols()), 256, 0.0, add, threads) /
         static_cast<double>(points.cols());
}

}  // namespace detail

/// A model that many scans are aligned with: what it needs of the model is computed once. Copies are cheap.
class shape_context_matcher {
 public:
  /// Throws gonio::error for options out of range, a mesh that `describe` refuses, or a model of which fewer than three
  /// points can be described.
  explicit shape_context_matcher(const triangle_mesh& model, const shape_context_alignment_options& options = {},
                                 thread_count threads = {})
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

  [[nodiscard]] const shape_context_alignment_options& options() const noexcept { return options_; }

  /// The rotation and translation that bring a scan to the model, by matches that are robust against wrong ones:
  /// least squares over the most significant matches, as the paper has it, then over all but the mistaken ones. That
  /// is deterministic, and the same bytes come out for any number of threads.
  ///
  /// O(bins points^2 + points^3 + points x neighbours + vertices log vertices). Throws gonio::error for a mesh that
  /// `describe` refuses, or if fewer than three points of the scan can be described or all of these lie on a line.
  [[nodiscard]] pre_alignment align(const triangle_mesh& scan, thread_count threads = {}) const {
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

 private:
  struct described_points {
    shape_descriptors descriptors;
    point_columns places;
  };

  struct described_model {
    described_model(const triangle_mesh& mesh, described_points some)
        : points(std::move(some)), vertices(detail::surface_vertices(mesh)), tree(vertices) {}

    described_points points;
    point_columns vertices;
    detail::point_tree tree;
  };

  [[nodiscard]] described_points described(const triangle_mesh& mesh, thread_count threads) const {
    shape_descriptors found = describe(mesh, spread_vertices(mesh, options_.points), options_.context, threads);
    point_columns places = mesh.vertices(Eigen::all, found.vertex);
    return {std::move(found), std::move(places)};
  }

  static void require_points(const shape_descriptors& descriptors, const char* what) {
    if (descriptors.vertex.size() < 3)
      throw error("a " + std::string(what) + " to be aligned by shape contexts has " +
                  std::to_string(descriptors.vertex.size()) +
                  " points that can be described, not three: are all normals along the vertical axis?");
  }

  shape_context_alignment_options options_;
  std::shared_ptr<const described_model> model_;
};

/// Aligns one scan: see `shape_context_matcher`, which many scans should share.
[[nodiscard]] inline pre_alignment align_by_shape_context(const triangle_mesh& scan, const triangle_mesh& model,
                                                          const shape_context_alignment_options& options = {},
                                                          thread_count threads = {}) {
  return shape_context_matcher(model, options, threads).align(scan, threads);
}

}  // namespace gonio
