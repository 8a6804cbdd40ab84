#pragma once
/// Recovers the missing parts of a partial scan with an active shape model. "Anatomically correct surface recovery"
/// (Nielsen, doctoral thesis, DTU 2016, contribution C.V), section 3, Algorithm 1.

#include <gonio/shape/fit_to_scan.hpp>

#include <Eigen/Core>

namespace gonio::shape {

/// The settings of a recovery.
struct recovery_options {
  fit_to_scan_options coarse;  ///< finds the pose, and tests whether the scan fits the model
  /// The fit that gives the result. It starts from the pose of `coarse`, and uses nearly all components.
  fit_to_scan_options fine{.correspondence = {}, .explained_variance = 0.9999, .position_error = 0.05, .robust = true};
  double confidence = 0.999;  ///< probability that a shape from the model's population passes the test
};

/// A recovered surface in the model's space. `pose.inverse()` maps it to the scan's space.
struct recovered_shape {
  triangle_mesh surface;
  vertex_observations known;  ///< the vertices that the scan shows, and their positions
  similarity_transform pose;  ///< from the scan to the model
  fit_to_scan_result fit;     ///< the fit that gave the result; in `recover_algorithm_1` the fit before its rounds
};

/// Recovers the missing parts of a scan from an approximate pose, by fitting the pose and the model's weights to the
/// visible parts. About half a second on one core for 3,000 vertices and 160 shapes.
///
/// Throws gonio::error as `require_shown` does, or if the shape does not fit the model: the squared distance of its
/// weights from the mean exceeds chi-square's quantile at `confidence` (section 2). If a scan shows all vertices, the
/// result is its denoised fit.
[[nodiscard]] recovered_shape recover(const shape_model& model, const surface_index& scan,
                                      const similarity_transform& pose, const recovery_options& options = {},
                                      thread_count threads = {});

/// The settings of Algorithm 1.
struct algorithm_1_options {
  fit_to_scan_options coarse;  ///< the fit before the rounds
  correspondence_options correspondence{.reach = 3.0, .normal_agreement = 0.5, .tangential = 1.0};
  double first_explained_variance = 0.30;
  double last_explained_variance = 0.999;
  int rounds = 10;  ///< rounds in which the explained variance rises
  /// The rounds for all vertices at once stop when the root mean square change of the shape is at most this, mm.
  double tolerance = 1e-3;
  int most_rounds = 200;         ///< rounds for all vertices at once
  int local_rounds = 3;          ///< rounds that predict each vertex from its nearest known vertices; may be 0
  Eigen::Index neighbours = 10;  ///< number of known vertices that predict a vertex in a local round
  /// In each round, aligns the shape to the mean and moves the scan by the same transform (line 4 of Algorithm 1).
  bool aligns = true;
  double confidence = 0.999;  ///< probability that a shape from the model's population passes the test
};

namespace detail {

[[nodiscard]] double explained_variance_in(int round, const algorithm_1_options& options);

}  // namespace detail

/// Recovers by Algorithm 1. Its solver is the truncated singular value decomposition, and all closest points have the
/// same weight. `recover` is more accurate (docs/learn/shapes.md). Throws as `recover` does.
[[nodiscard]] recovered_shape recover_algorithm_1(const shape_model& model, const surface_index& scan,
                                                  const similarity_transform& pose,
                                                  const algorithm_1_options& options = {}, thread_count threads = {});

/// Runs Algorithm 1 from a given fit. Ignores `options.coarse` and `options.confidence`. Throws gonio::error as
/// `require_shown` and `fit_shape` do.
[[nodiscard]] recovered_shape recover_algorithm_1(const shape_model& model, const surface_index& scan,
                                                  fit_to_scan_result initial, const algorithm_1_options& options = {},
                                                  thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/recovery.ipp>
#endif
