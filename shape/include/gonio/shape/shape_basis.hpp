#pragma once
/// Principal components of corresponded shapes: the same `pca` as for BRDFs, over the coordinates of vertices.
/// "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), Eq. 1-2 and 4. The
/// metric is the identity, `lin`.

#include <gonio/basis/pca.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/shape/triangle_mesh.hpp>
#include <gonio/table/domain.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace gonio::shape {

/// The domain of shapes: the coordinates x, y, z of the first vertex, then of the next.
struct vertex_coordinates {
  Eigen::Index vertices = 0;

  /// A shape has one value per coordinate.
  static constexpr int channels = 1;
  [[nodiscard]] Eigen::Index size() const noexcept { return 3 * vertices; }
  [[nodiscard]] friend bool operator==(const vertex_coordinates&, const vertex_coordinates&) = default;
};

[[nodiscard]] inline location locate_cell(const vertex_coordinates& /*coordinates*/, Eigen::Index coordinate) noexcept {
  return location_of(coordinate);
}

static_assert(domain<vertex_coordinates>);

/// Named, aligned shapes of the same vertices. `values` has a row per coordinate and a column per shape.
struct shape_set {
  vertex_coordinates cells;
  std::vector<std::string> names;
  cell_matrix values;

  /// Throws gonio::error if there is no shape or no vertex, if the numbers of names and shapes or of vertices differ,
  /// or if a vertex is not finite.
  [[nodiscard]] static shape_set of(const std::vector<point_columns>& shapes, std::vector<std::string> names);
};

static_assert(observation_set<shape_set>);

using shape_basis = pca<lin, vertex_coordinates>;

static_assert(tabulated_basis<shape_basis>);

[[nodiscard]] point_columns mean_shape(const shape_basis& basis);

/// Returns mu + Q w (Eq. 2): the shape with weights w. The covariance of w over the m shapes of the basis is I / m.
/// O(size of the basis x vertices).
[[nodiscard]] point_columns shape_of(const shape_basis& basis, const Eigen::VectorXd& weights);

/// Returns the squared Mahalanobis distance of weights from the mean: m |w|^2 for a basis of m shapes. For shapes from
/// the model's population it has a chi-square distribution with one degree of freedom per weight (section 2).
[[nodiscard]] double squared_mahalanobis(const shape_basis& basis, const Eigen::VectorXd& weights);

/// Returns the basis with the fewest components that explain a share of the shapes' variance. Throws gonio::error
/// unless the share is above 0 and at most 1.
[[nodiscard]] shape_basis truncated_to_variance(const shape_basis& basis, double share);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/shape_basis.ipp>
#endif
