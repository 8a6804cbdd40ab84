#pragma once
/// Brings a scan in any pose near a model, by points that look alike: the alignment from which a fit can start.
/// "Anatomically correct surface recovery" (Nielsen's doctoral thesis, DTU 2016, contribution C.V), section 2.

#include <gonio/shape/alignment.hpp>
#include <gonio/shape/shape_context.hpp>

#include <Eigen/Core>

#include <memory>
#include <utility>

namespace gonio::shape {

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
  Eigen::Index matches = 0;         ///< that determined the pose
};

namespace detail {

/// Corresponded points in the order of their matches.
struct matched_points {
  point_columns from, onto;

  [[nodiscard]] Eigen::VectorXd squared_distances(const similarity_transform& pose) const;
};

/// The paper's least squares over the first matches, then weighted ones over all matches: a weight falls with the
/// square of the distance and ends at a limit, which narrows from three times the root mean square until the tolerance,
/// and then stays until the pose does. Narrowing ends early where less than a tenth of the matches would be left. It is
/// an M-estimate with Epanechnikov's weights, approached from far as by Blake and Zisserman's graduated non-convexity.
[[nodiscard]] std::pair<similarity_transform, Eigen::Index> robust_pose(const matched_points& points,
                                                                        Eigen::Index first, double tolerance);

}  // namespace detail

/// A model that many scans are aligned with: what it needs of the model is computed once. Copies are cheap.
class shape_context_matcher {
 public:
  /// Throws gonio::error for options out of range, a mesh that `describe` refuses, or a model of which fewer than three
  /// points can be described.
  explicit shape_context_matcher(const triangle_mesh& model, const shape_context_alignment_options& options = {},
                                 thread_count threads = {});

  [[nodiscard]] const shape_context_alignment_options& options() const noexcept { return options_; }

  /// The rotation and translation that bring a scan to the model, by matches that are robust against wrong ones:
  /// least squares over the most significant matches, as the paper has it, then over all but the mistaken ones. That
  /// is deterministic, and the same bytes come out for any number of threads.
  ///
  /// O(bins points^2 + points^3 + points x neighbours + vertices log vertices). Throws gonio::error for a mesh that
  /// `describe` refuses, or if fewer than three points of the scan can be described or all of these lie on a line.
  [[nodiscard]] pre_alignment align(const triangle_mesh& scan, thread_count threads = {}) const;

 private:
  struct described_model;

  shape_context_alignment_options options_;
  std::shared_ptr<const described_model> model_;
};

/// Aligns one scan: see `shape_context_matcher`, which many scans should share.
[[nodiscard]] pre_alignment align_by_shape_context(const triangle_mesh& scan, const triangle_mesh& model,
                                                   const shape_context_alignment_options& options = {},
                                                   thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/shape_context_alignment.ipp>
#endif
