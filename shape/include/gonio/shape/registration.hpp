#pragma once
/// Registers a scan: moves the vertices of a fitted model onto the scan's surface, and tests the resulting shape.
/// "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), section 2.

#include <gonio/shape/fit_to_scan.hpp>

#include <string>

namespace gonio::shape {

/// The settings of the registration and of its tests (section 2).
struct registration_options {
  fit_to_scan_options fit;
  double reach = 2.0;  ///< search distance along a normal, mm
  /// Realigns the points on the scan with the fitted shape in each round, as in section 2; docs/results/shapes.md gives
  /// the effect.
  bool realigns = false;
  /// Largest number of rounds. Each smooths the shape and moves its vertices along their normals onto the scan.
  int rounds = 20;
  double tolerance = 0.01;     ///< stops when the root mean square displacement of the vertices is smaller, mm
  double most_missing = 0.12;  ///< largest fraction of vertices that the scan does not show
  double confidence = 0.999;   ///< probability that a shape from the model's population passes
  double least_angle = 15.0;   ///< least 20th percentile of the triangles' smallest angles, degrees
  double least_normal_agreement = 0.75;  ///< least mean cosine between the normals of fit and registration
};

/// A scan as a shape of the model, with the results of its tests.
struct registration {
  point_columns vertices;                                                             ///< in the model's space
  similarity_transform pose;                                                          ///< from the scan to the model
  double squared_distance = 0.0, angle = 0.0, normal_agreement = 0.0, missing = 0.0;  ///< in the options' units
  std::string refusal;  ///< one sentence; empty if all tests passed

  [[nodiscard]] bool accepted() const noexcept { return refusal.empty(); }
};

/// Returns the quantile `share` of the triangles' smallest angles, in degrees.
[[nodiscard]] double smallest_angle_percentile(const triangle_mesh& mesh, double share);

/// Registers a scan from an approximate pose. Vertices that the scan does not show start at the fitted model; each
/// round then replaces them by the mean of themselves and their neighbours. Throws gonio::error as `require_shown`
/// does.
[[nodiscard]] registration register_scan(const shape_model& model, const surface_index& scan,
                                         const similarity_transform& pose, const registration_options& options = {},
                                         thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/registration.ipp>
#endif
