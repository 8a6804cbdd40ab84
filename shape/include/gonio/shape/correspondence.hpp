#pragma once
/// Where the vertices of a shape are on a scan, and which of them the scan does not show.
/// "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), sections 2 and 3.

#include <gonio/core/parallel.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/fitted_shape.hpp>
#include <gonio/shape/surface_index.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace gonio::shape {

/// A scan and where it lies: `pose` takes its coordinates to those of the model.
struct posed_scan {
  surface_index surface;
  similarity_transform pose;
  Eigen::RowVectorXd weights = {};  ///< none, or how much each vertex of the surface counts: see `vertex_observations`

  /// The nearest place to a point of the model's space, in that space.
  [[nodiscard]] surface_point closest(const Eigen::Vector3d& point) const;

  /// The nearest place on a line through a point of the model's space, at most `reach` away.
  [[nodiscard]] std::optional<surface_point> along(const Eigen::Vector3d& point, const Eigen::Vector3d& line,
                                                   double reach) const;

  /// The outward normal at a place that was found, in the model's space: see `surface_index::pseudonormal`.
  [[nodiscard]] Eigen::Vector3d normal(const surface_point& place) const;

  /// How much a place counts: 1 if nothing is said about the surface's vertices.
  [[nodiscard]] double weight_at(const surface_point& place) const;

 private:
  [[nodiscard]] surface_point placed(surface_point found) const;
};

/// When a vertex counts as shown by a scan.
struct correspondence_options {
  double reach = 3.0;             ///< farther places belong to something else, mm
  double normal_agreement = 0.5;  ///< least cosine between the normals of shape and scan
  double tangential = 0.0003;     ///< how much a place counts along the surface: see `vertex_observations`
};

/// Places on a scan of those vertices that it shows, with the normals of the shape that looked for them.
[[nodiscard]] vertex_observations shown_vertices(const point_columns& places, const point_columns& normals,
                                                 const std::vector<char>& shown, double tangential);

/// The place on the scan of each vertex of a shape that is there.
///
/// What is off across the surface is measured along the shape's normals, not the scan's: those of a triangle are off by
/// some degrees where the scan is noisy by a tenth of its length, and vertices that slide along such a surface seem to
/// leave it.
[[nodiscard]] vertex_observations closest_places(const posed_scan& scan, const triangle_mesh& shape,
                                                 const correspondence_options& options = {}, thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/correspondence.ipp>
#endif
