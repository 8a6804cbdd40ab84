#pragma once
/// Aligns a scan in any pose with a model by matching similar points, as a start for a fit. "Anatomically correct
/// surface recovery" (Nielsen's doctoral thesis, DTU 2016, contribution C.V), section 2.

#include <gonio/shape/alignment.hpp>
#include <gonio/shape/shape_context.hpp>

#include <Eigen/Core>

#include <memory>
#include <utility>

namespace gonio::shape {

/// The settings of the alignment. Lengths are in millimetres by default.
struct shape_context_alignment_options {
  shape_context_options context;
  Eigen::Index points = 300;       ///< number of points described on each surface
  double significant = 1.0 / 3.0;  ///< fraction of the matches, the best ones, that give the first pose
  double tolerance = 5.0;          ///< matches farther apart are ignored at the end; infinity keeps the first pose
};

/// A pose and the quality of its fit.
struct pre_alignment {
  similarity_transform transform;  ///< from the scan's to the model's coordinates; scale 1
  double mean_distance = 0.0;  ///< from the model's vertices to the closest scanned ones; the paper rejects above 5 mm
  double mean_scan_distance = 0.0;  ///< from the scanned vertices to the model's closest; holes do not increase it
  Eigen::Index matches = 0;         ///< number of matches that determined the pose
};

namespace detail {

/// Corresponding points in the order of their matches.
struct matched_points {
  point_columns from, onto;

  [[nodiscard]] Eigen::VectorXd squared_distances(const similarity_transform& pose) const;
};

/// Returns the pose, and the number of matches that determine it. Starts with the paper's least squares over the first
/// matches, and continues with weighted least squares over all. A weight falls with the squared distance and is zero
/// above a limit. The limit narrows from three times the root mean square distance to the tolerance, and stays there
/// until the pose converges. The iteration stops early if fewer than a tenth of the matches, or three, would remain.
/// This is an M-estimate with Epanechnikov weights, by Blake and Zisserman's graduated non-convexity.
[[nodiscard]] std::pair<similarity_transform, Eigen::Index> robust_pose(const matched_points& points,
                                                                        Eigen::Index first, double tolerance);

}  // namespace detail

/// Aligns many scans with one model, which it describes once. Copies are cheap.
class shape_context_matcher {
 public:
  /// Throws gonio::error for options out of range, for a mesh that `describe` refuses, or if fewer than three points of
  /// the model can be described.
  explicit shape_context_matcher(const triangle_mesh& model, const shape_context_alignment_options& options = {},
                                 thread_count threads = {});

  [[nodiscard]] const shape_context_alignment_options& options() const noexcept { return options_; }

  /// Returns the rotation and translation from a scan to the model, robust against wrong matches: least squares over
  /// the most significant matches, as in the paper, then over all but the wrong ones. The bytes do not depend on the
  /// number of threads.
  ///
  /// O(bins points^2 + points^3 + points x neighbours + vertices log vertices). Throws gonio::error for a mesh that
  /// `describe` refuses, if fewer than three points of the scan can be described, or if all of these lie on a line.
  [[nodiscard]] pre_alignment align(const triangle_mesh& scan, thread_count threads = {}) const;

 private:
  struct described_model;

  shape_context_alignment_options options_;
  std::shared_ptr<const described_model> model_;
};

/// Aligns one scan. For many scans, share a `shape_context_matcher`.
[[nodiscard]] pre_alignment align_by_shape_context(const triangle_mesh& scan, const triangle_mesh& model,
                                                   const shape_context_alignment_options& options = {},
                                                   thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/shape_context_alignment.ipp>
#endif
