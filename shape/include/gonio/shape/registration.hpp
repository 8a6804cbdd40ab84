#pragma once
/// Propagates a fitted model to the surface of a scan, which gives a new shape of the model's vertices, and tests it.
/// "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), section 2.

#include <gonio/shape/fit_to_scan.hpp>

#include <string>

namespace gonio::shape {

/// The settings of the propagation and of the tests (section 2).
struct registration_options {
  fit_to_scan_options fit;
  double reach = 2.0;  ///< search distance along a normal, mm
  /// Realigns the points on the scan with the fitted shape in each round, as in section 2. The fit has already found
  /// the pose; docs/results/shapes.md gives the effect.
  bool realigns = false;
  int rounds = 20;                       ///< largest number of rounds of smoothing and propagating
  double tolerance = 0.01;               ///< the rounds stop at a smaller change, root mean square in mm
  double most_missing = 0.12;            ///< largest fraction of vertices that the scan does not show
  double confidence = 0.999;             ///< probability that the weights of a shape of the family are accepted
  double least_angle = 15.0;             ///< for the 20th percentile of the triangles' smallest angles, degrees
  double least_normal_agreement = 0.75;  ///< mean cosine between the normals of the fit and the registration
};

/// A scan as a shape of the model, or the reason why it was refused.
struct registration {
  point_columns vertices;                                                             ///< in the model's space
  similarity_transform pose;                                                          ///< from the scan to the model
  double squared_distance = 0.0, angle = 0.0, normal_agreement = 0.0, missing = 0.0;  ///< results of the tests
  std::string refusal;  ///< one sentence; empty if it passed

  [[nodiscard]] bool accepted() const noexcept { return refusal.empty(); }
};

/// Returns the percentile `share` of the triangles' smallest angles, in degrees.
[[nodiscard]] double smallest_angle_percentile(const triangle_mesh& mesh, double share);

/// Registers a scan from an approximate pose. Vertices that the scan does not show get the model's prediction. Throws
/// gonio::error if the scan shows hardly any vertices.
[[nodiscard]] registration register_scan(const shape_model& model, const surface_index& scan,
                                         const similarity_transform& pose, const registration_options& options = {},
                                         thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/registration.ipp>
#endif
