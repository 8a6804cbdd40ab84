#pragma once
/// Fits an active shape model to a scan: alternately finds closest points, and fits pose and weights to them.
/// "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), section 2, Eq. 3;
/// closest points as in Besl and McKay, IEEE PAMI 14(2), 1992 (doi:10.1109/34.121791).
///
/// The paper finds the weights by downhill simplex and the pose by closest points. Here, one least-squares problem
/// gives both for fixed closest points: docs/decisions/0012-weights-by-least-squares.md.

#include <gonio/shape/correspondence.hpp>
#include <gonio/shape/shape_model.hpp>
#include <gonio/shape/shape_uncertainty.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Core>

namespace gonio::shape {

/// The settings of a fit.
struct fit_to_scan_options {
  correspondence_options correspondence;
  double explained_variance = 0.99;  ///< fraction of the variance that the used components explain (section 2)
  /// Expected error in mm of the positions found on the scan, if the weights are right: the model is not exact, and
  /// closest points are not exactly the corresponding points. This error balances the scan against the mean shape. The
  /// scan's own noise adds to it, so noisy parts of the scan get less weight.
  double position_error = 0.3;
  /// Down-weights outlying correspondences (Geman-McClure). Noise at the edges of holes then counts little, but
  /// `squared_distance` no longer reveals a scan of another object.
  bool robust = false;
  /// Keeps the given pose and fits only the shape. `uncertainty` still includes the motion and is wider than necessary.
  bool holds_pose = false;
  double tolerance = 1e-3;  ///< stops when the root mean square change of the vertices is smaller, mm
  int most_iterations = 100;
};

/// A model fitted to a scan.
struct fit_to_scan_result {
  similarity_transform pose;            ///< from the scan to the model
  shape_with_motion functions;          ///< the components used and the motion, in the model's space
  Eigen::VectorXd all_weights;          ///< the weights of all `functions`
  vertex_observations correspondences;  ///< the vertices that the scan shows
  tikhonov solver;                      ///< the solver that found the weights
  int iterations = 0;

  /// Returns the vertices in the model's space. `pose` includes their motion.
  [[nodiscard]] point_columns shape() const;
  /// Returns the weights of the components used, see `shape_of`.
  [[nodiscard]] Eigen::VectorXd weights() const;
  /// See `squared_mahalanobis`.
  [[nodiscard]] double squared_distance() const;
  /// Returns the uncertainty of the vertices in the model's space, if the observed positions are right. It includes the
  /// motion, but not sliding along the surface, which `cross_validated_uncertainty` measures.
  [[nodiscard]] shape_uncertainty uncertainty() const;
};

/// Throws gonio::error unless a scan shows at least 10 of a model's vertices.
void require_shown(const vertex_observations& correspondences, const shape_model& model);

namespace detail {

/// Returns the Geman-McClure weights 1 / (1 + (d / d0)^2)^2 of points of a scan at distances d from the shape. d0 is
/// three times the position error, or three times the median distance if that is larger.
[[nodiscard]] Eigen::VectorXd inlier_weights(const vertex_observations& correspondences, const point_columns& shape,
                                             double position_error);

}  // namespace detail

/// Fits a model from an approximate pose. Throws gonio::error as `require_shown` does.
[[nodiscard]] fit_to_scan_result fit_to_scan(const shape_model& model, const surface_index& scan,
                                             const similarity_transform& pose, const fit_to_scan_options& options = {},
                                             thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/fit_to_scan.ipp>
#endif
