#pragma once
/// Finds the vertices of a shape that a scan shows, and their positions on the scan. "Anatomically correct surface
/// recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), sections 2 and 3.

#include <gonio/core/parallel.hpp>
#include <gonio/shape/alignment.hpp>
#include <gonio/shape/fitted_shape.hpp>
#include <gonio/shape/surface_index.hpp>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace gonio::shape {

/// A scan and its pose. `pose` maps the scan's coordinates to the model's.
struct posed_scan {
  surface_index surface;
  similarity_transform pose;
  Eigen::RowVectorXd weights = {};  ///< empty, or the weight of each vertex of the surface: see `vertex_observations`

  /// Returns the closest point of the scan, in the model's space.
  [[nodiscard]] surface_point closest(const Eigen::Vector3d& point) const;

  /// Returns the nearest intersection with a line through a point, at most `reach` away, in the model's space.
  [[nodiscard]] std::optional<surface_point> along(const Eigen::Vector3d& point, const Eigen::Vector3d& line,
                                                   double reach) const;

  /// Returns the outward normal at a point that `closest` or `along` found, in the model's space: see
  /// `surface_index::pseudonormal`.
  [[nodiscard]] Eigen::Vector3d normal(const surface_point& point) const;

  /// Returns the weight at a point; 1 if the surface's vertices have no weights.
  [[nodiscard]] double weight_at(const surface_point& point) const;

 private:
  [[nodiscard]] surface_point in_model_space(surface_point found) const;
};

/// The conditions for a scan to show a vertex, and the weight of its residuals.
struct correspondence_options {
  double reach = 3.0;             ///< largest distance of a vertex from its point on the scan, mm
  double normal_agreement = 0.5;  ///< smallest cosine between the normals of shape and scan
  double tangential = 0.0003;     ///< weight along the surface: see `vertex_observations`
};

/// Returns the marked vertices, with their columns of `positions` and `normals`.
[[nodiscard]] vertex_observations shown_vertices(const point_columns& positions, const point_columns& normals,
                                                 const std::vector<char>& shown, double tangential);

/// Returns, for each vertex that the scan shows, the closest point of the scan. This point must not be on the scan's
/// border and must meet `options`.
///
/// The normals are the shape's, not the scan's. Noise of a tenth of the edge length turns the scan's triangle normals
/// by some degrees; with these, a vertex that slides along the surface would seem to leave it.
[[nodiscard]] vertex_observations closest_correspondences(const posed_scan& scan, const triangle_mesh& shape,
                                                          const correspondence_options& options = {},
                                                          thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/correspondence.ipp>
#endif
