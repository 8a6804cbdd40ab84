#pragma once
/// Recovers the missing parts of a partial scan with an active shape model. "Anatomically correct surface recovery"
/// (Nielsen, doctoral thesis, DTU 2016, contribution C.V), section 3, Algorithm 1.

#include <gonio/shape/fit_to_scan.hpp>

#include <Eigen/Core>

namespace gonio::shape {

/// The settings of a recovery.
struct recovery_options {
  fit_to_scan_options coarse;  ///< finds the pose, and tests whether the scan belongs to the family
  /// Gives the result: uses nearly all components, for a scan with this little noise.
  fit_to_scan_options fine{.correspondence = {}, .explained_variance = 0.9999, .position_error = 0.05, .robust = true};
  double confidence = 0.999;  ///< probability that a shape of the family is accepted
};

/// A recovered surface in the model's space. `pose.inverse()` maps it to the scan's space.
struct recovered_shape {
  triangle_mesh surface;
  vertex_observations known;  ///< the vertices that the scan shows, and their positions
  similarity_transform pose;  ///< from the scan to the model
  fit_to_scan_result fit;     ///< the fit that gave the result, or that it started from
};

/// Recovers the missing parts of a scan from an approximate pose, by fitting the pose and the family's weights to the
/// visible parts. About half a second on one core for 3,000 vertices and 160 shapes.
///
/// Throws gonio::error if the scan shows hardly any vertex of the model, or if its shape is not of the family: the
/// squared distance of its weights from the mean exceeds chi-square's quantile (section 2). If a scan shows all
/// vertices, the result is its denoised fit.
[[nodiscard]] recovered_shape recover(const shape_model& model, const surface_index& scan,
                                      const similarity_transform& pose, const recovery_options& options = {},
                                      thread_count threads = {});

/// The settings of Algorithm 1.
struct algorithm_1_options {
  fit_to_scan_options coarse;  ///< the fit before the rounds
  correspondence_options correspondence{.reach = 3.0, .normal_agreement = 0.5, .tangential = 1.0};
  double first_explained_variance = 0.30;
  double last_explained_variance = 0.999;
  int rounds = 10;               ///< rounds for all vertices at once, with rising explained variance
  int local_rounds = 3;          ///< rounds vertex by vertex, which smooth locally; may be 0
  Eigen::Index neighbours = 10;  ///< known vertices that predict one in a local round
  bool aligns = true;            ///< aligns the shape to the mean, and the scan with it, in each round (line 4)
  double confidence = 0.999;     ///< probability that a shape of the family is accepted
};

namespace detail {

/// Returns Algorithm 1's explained variance in a round.
[[nodiscard]] double explained_variance_in(int round, const algorithm_1_options& options);

}  // namespace detail

/// Algorithm 1: recovers like `recover`, but with truncated singular values and closest points of full weight. The
/// paper compares this method with others; `recover` is more accurate (docs/learn/shapes.md). The returned fit is the
/// one before the rounds. Throws as `recover` does.
[[nodiscard]] recovered_shape recover_algorithm_1(const shape_model& model, const surface_index& scan,
                                                  const similarity_transform& pose,
                                                  const algorithm_1_options& options = {}, thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/recovery.ipp>
#endif
