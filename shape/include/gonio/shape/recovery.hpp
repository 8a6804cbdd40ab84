#pragma once
/// What a partial scan does not show, recovered by an active shape model.
/// "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), section 3,
/// Algorithm 1.

#include <gonio/shape/fit_to_scan.hpp>

#include <Eigen/Core>

namespace gonio::shape {

/// How a partial scan is recovered.
struct recovery_options {
  fit_to_scan_options coarse;  ///< finds the pose, and whether the scan is of the family
  /// What is recovered: nearly all components, on a scan whose noise is this small.
  fit_to_scan_options fine{.correspondence = {}, .explained_variance = 0.9999, .position_error = 0.05, .robust = true};
  double confidence = 0.999;  ///< that a shape of the family is not refused
};

/// A recovered surface. All is in the model's space; `pose.inverse()` takes it to the scan's.
struct recovered_shape {
  triangle_mesh surface;
  vertex_observations known;  ///< the vertices that the scan shows, and where
  similarity_transform pose;  ///< from the scan to the model
  fit_to_scan_result fit;     ///< what the recovery is, or began with
};

/// Recovers what a scan does not show, from a pose that is about right, by the pose and the weights of the family that
/// fit what it shows. About half a second on one core for 3,000 vertices and 160 shapes.
///
/// Throws gonio::error if the scan shows hardly any vertex of the model, or if its shape is not of the family: the
/// squared distance of its weights from the mean is above chi-square's quantile (section 2). A scan that shows all
/// vertices comes back as the model sees it: less noisy.
[[nodiscard]] recovered_shape recover(const shape_model& model, const surface_index& scan,
                                      const similarity_transform& pose, const recovery_options& options = {},
                                      thread_count threads = {});

/// The rounds of Algorithm 1.
struct algorithm_1_options {
  fit_to_scan_options coarse;  ///< that the rounds begin with
  correspondence_options correspondence{.reach = 3.0, .normal_agreement = 0.5, .tangential = 1.0};
  double first_explained_variance = 0.30;
  double last_explained_variance = 0.999;
  int rounds = 10;               ///< of all vertices at once, while the explained variance rises
  int local_rounds = 3;          ///< vertex by vertex, which smooths locally; 0 to go without
  Eigen::Index neighbours = 10;  ///< known vertices that predict one in a local round
  bool aligns = true;            ///< the shape with the mean, and the scan with it, in each round (line 4)
  double confidence = 0.999;     ///< that a shape of the family is not refused
};

namespace detail {

/// Algorithm 1's explained variance in a round.
[[nodiscard]] double explained_variance_in(int round, const algorithm_1_options& options);

}  // namespace detail

/// Algorithm 1: the same as `recover` by truncated singular values and closest places, which count in full.
/// `recover` comes closer to the surface (docs/learn/shapes.md); this is what the paper compares with others. The fit
/// that it returns is the one that it began with. Throws as `recover` does.
[[nodiscard]] recovered_shape recover_algorithm_1(const shape_model& model, const surface_index& scan,
                                                  const similarity_transform& pose,
                                                  const algorithm_1_options& options = {}, thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/recovery.ipp>
#endif
