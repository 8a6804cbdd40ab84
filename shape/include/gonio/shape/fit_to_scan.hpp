#pragma once
/// Fits an active shape model to a scan, alternating closest points with pose and weights. "Anatomically correct
/// surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), section 2, Eq. 3; closest points as in
/// Besl and McKay, IEEE PAMI 14(2), 1992 (doi:10.1109/34.121791).
///
/// The paper finds the weights by downhill simplex and the pose by closest points. For fixed points on the scan, both
/// together are one least-squares problem, which the BRDF solver solves:
/// docs/decisions/0012-weights-by-least-squares.md.

#include <gonio/shape/correspondence.hpp>
#include <gonio/shape/shape_model.hpp>
#include <gonio/shape/shape_uncertainty.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Core>

namespace gonio::shape {

/// The settings of a fit.
struct fit_to_scan_options {
  correspondence_options correspondence;
  double explained_variance = 0.99;  ///< of the components that are used (section 2)
  /// The error in mm of vertices on the scan even with the right weights: the model error of the family, and closest
  /// points that are not the corresponding ones. It balances the scan against the family. Where the scan is noisier
  /// than this, it gets less weight.
  double position_error = 0.3;
  /// Down-weights outlying correspondences (Geman-McClure). Noise at the edges of holes then counts little, but the
  /// weights no longer reveal a scan of something else.
  bool robust = false;
  /// Keeps the given pose and fits only the shape. `uncertainty` ignores this and is wider than necessary.
  bool holds_pose = false;
  double tolerance = 1e-3;  ///< the iteration stops at a smaller change of the shape, root mean square in mm
  int most_iterations = 100;
};

/// A model on a scan.
struct fit_to_scan_result {
  similarity_transform pose;    ///< from the scan to the model
  shape_with_motion functions;  ///< in the model's space: the components used, and motion
  Eigen::VectorXd all_weights;  ///< of all these functions
  vertex_observations places;   ///< the vertices that the scan shows
  tikhonov solver;              ///< the solver that found the weights
  int iterations = 0;

  /// Returns the vertices in the model's space. The pose includes their motion.
  [[nodiscard]] point_columns shape() const;
  /// Returns the weights of the components used, see `shape_of`.
  [[nodiscard]] Eigen::VectorXd weights() const;
  /// See `squared_mahalanobis`.
  [[nodiscard]] double squared_distance() const;
  /// Returns the uncertainty of the vertices, equal in the scan's and the model's space, if the observed positions are
  /// right. It includes the motion but not the sliding of vertices along the surface, which
  /// `cross_validated_uncertainty` measures.
  [[nodiscard]] shape_uncertainty uncertainty() const;
};

/// Throws gonio::error unless a scan shows enough vertices of a model to align it.
void require_shown(const vertex_observations& places, const shape_model& model);

namespace detail {

/// Returns Geman-McClure weights of points on a scan. They are nearly 1 up to three times the position error (or three
/// times the median distance, if that is larger) and nearly 0 at noisy edges of holes and spurious triangles.
[[nodiscard]] Eigen::VectorXd inlier_weights(const vertex_observations& places, const point_columns& shape,
                                             double position_error);

}  // namespace detail

/// Fits a model from an approximate pose. Throws gonio::error if the scan shows hardly any vertex of the model.
[[nodiscard]] fit_to_scan_result fit_to_scan(const shape_model& model, const surface_index& scan,
                                             const similarity_transform& pose, const fit_to_scan_options& options = {},
                                             thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/fit_to_scan.ipp>
#endif
