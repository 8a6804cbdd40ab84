#pragma once
/// An active shape model brought onto a scan: closest places in turn with the pose and the weights that go there.
/// "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), section 2, Eq. 3;
/// closest points as Besl and McKay, IEEE PAMI 14(2), 1992 (doi:10.1109/34.121791).
///
/// The paper finds the weights by downhill simplex, the pose by closest points. With the places on the scan held both
/// are one least-squares problem, which the solver of BRDFs solves at once:
/// docs/decisions/0012-weights-by-least-squares.md.

#include <gonio/shape/correspondence.hpp>
#include <gonio/shape/shape_model.hpp>
#include <gonio/shape/shape_uncertainty.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Core>

namespace gonio::shape {

/// How a model is brought onto a scan.
struct fit_to_scan_options {
  correspondence_options correspondence;
  double explained_variance = 0.99;  ///< of the components that take part (section 2)
  /// How far vertices are from where they should be on the scan though the weights are right, mm: by what the family
  /// cannot say, and because the closest place of a scan is not the corresponding one. Decides how much the scan is
  /// trusted against the family; where the scan is noisier than this, it is trusted less.
  double position_error = 0.3;
  /// Down-weight outlying correspondences (Geman-McClure). Noise at the edges of holes then counts little, but the
  /// weights no longer tell a scan of something else.
  bool robust = false;
  /// Is the pose right as it is, so that only the shape is fitted? `uncertainty` does not know: it is wider than it
  /// need be.
  bool holds_pose = false;
  double tolerance = 1e-3;  ///< the change of the shape that ends the iteration, root mean square in mm
  int most_iterations = 100;
};

/// A model on a scan.
struct fit_to_scan_result {
  similarity_transform pose;    ///< from the scan to the model
  shape_with_motion functions;  ///< in the model's space: the components that took part, and motion
  Eigen::VectorXd all_weights;  ///< of these functions
  vertex_observations places;   ///< where the scan shows the vertices
  tikhonov solver;              ///< what found the weights
  int iterations = 0;

  /// The vertices in the model's space, where the pose has taken their motion.
  [[nodiscard]] point_columns shape() const;
  /// Of the components that took part, see `shape_of`.
  [[nodiscard]] Eigen::VectorXd weights() const;
  /// See `squared_mahalanobis`.
  [[nodiscard]] double squared_distance() const;
  /// How sure the vertices are, in the scan's space as in the model's, if the places are where they belong: motion is
  /// as unsure as the rest. What vertices slide along the surface is not in it: `cross_validated_uncertainty` measures
  /// it.
  [[nodiscard]] shape_uncertainty uncertainty() const;
};

/// Throws gonio::error unless a scan shows enough vertices of a model to be aligned by.
void require_shown(const vertex_observations& places, const shape_model& model);

namespace detail {

/// Weights of places on a scan (Geman and McClure): nearly 1 up to three times the position error
/// or, while the shape is far off, three times what is usual; nearly 0 at noisy edges of holes and spurious triangles.
[[nodiscard]] Eigen::VectorXd inlier_weights(const vertex_observations& places, const point_columns& shape,
                                             double position_error);

}  // namespace detail

/// From a pose that is about right. Throws gonio::error if the scan shows hardly any vertex of the model.
[[nodiscard]] fit_to_scan_result fit_to_scan(const shape_model& model, const surface_index& scan,
                                             const similarity_transform& pose, const fit_to_scan_options& options = {},
                                             thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/fit_to_scan.ipp>
#endif
