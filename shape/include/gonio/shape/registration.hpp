#pragma once
/// A fitted model propagated to the surface of a scan, so that a new shape of the model's vertices comes out, and the
/// tests that it must pass. "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution
/// C.V), section 2.

#include <gonio/shape/fit_to_scan.hpp>

#include <string>

namespace gonio::shape {

/// How a model is propagated, and what is accepted (section 2).
struct registration_options {
  fit_to_scan_options fit;
  double reach = 2.0;  ///< along a normal, mm
  /// Are the places on the scan aligned with the fitted shape anew in each round, as section 2 has it? The fit has
  /// found the pose already: docs/results/shapes.md says what this is worth.
  bool realigns = false;
  int rounds = 20;                       ///< of smoothing and propagating, at most
  double tolerance = 0.01;               ///< the change that ends them, root mean square in mm
  double most_missing = 0.12;            ///< share of the vertices that the scan may not show
  double confidence = 0.999;             ///< that the weights of a shape of the family are not refused
  double least_angle = 15.0;             ///< of the 20th percentile of the triangles' smallest angles, degrees
  double least_normal_agreement = 0.75;  ///< mean cosine between the normals of the fit and the registration
};

/// A scan as a shape of the model, or why it is none.
struct registration {
  point_columns vertices;                                                             ///< in the model's space
  similarity_transform pose;                                                          ///< from the scan to the model
  double squared_distance = 0.0, angle = 0.0, normal_agreement = 0.0, missing = 0.0;  ///< what the tests look at
  std::string refusal;  ///< one sentence; empty if it passed

  [[nodiscard]] bool accepted() const noexcept { return refusal.empty(); }
};

/// The smallest angle of a share of the triangles is below the returned, in degrees.
[[nodiscard]] double smallest_angle_percentile(const triangle_mesh& mesh, double share);

/// Registers a scan from a pose that is about right. Vertices that the scan does not show take the place that the model
/// predicts. Throws gonio::error if the scan shows hardly any.
[[nodiscard]] registration register_scan(const shape_model& model, const surface_index& scan,
                                         const similarity_transform& pose, const registration_options& options = {},
                                         thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/registration.ipp>
#endif
