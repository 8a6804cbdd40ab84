#pragma once
/// Principal components of corresponded shapes: the basis that BRDFs have, over the coordinates of vertices.
/// "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), Eq. 1-2 and 4; the
/// metric is the identity, `lin`.

#include <gonio/basis/learn_pca.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// The coordinates x, y, z of the first vertex, then of the next: the domain of shapes.
struct vertex_coordinates {
  std::size_t vertices = 0;

  /// A shape has one value at each.
  static constexpr int channels = 1;
  [[nodiscard]] std::size_t size() const noexcept { return 3 * vertices; }
  [[nodiscard]] friend bool operator==(const vertex_coordinates&, const vertex_coordinates&) = default;
};

[[nodiscard]] inline location locate_cell(const vertex_coordinates& /*coordinates*/, std::size_t coordinate) noexcept {
  return location_of(coordinate);
}

static_assert(domain<vertex_coordinates>);

/// Named shapes of the same vertices, aligned to one another; `values` has shape (3 vertices, shapes).
struct shape_set {
  vertex_coordinates cells;
  std::vector<std::string> names;
  cell_matrix values;

  /// Throws gonio::error if there is none, one has no name or another number of vertices than the first, or a vertex is
  /// not finite.
  [[nodiscard]] static shape_set of(const std::vector<point_columns>& shapes, std::vector<std::string> names) {
    if (shapes.empty() || shapes.size() != names.size() || shapes[0].cols() == 0)
      throw error("a set of shapes needs at least one, of at least one vertex, and a name for each: not " +
                  std::to_string(shapes.size()) + " shapes and " + std::to_string(names.size()) + " names");
    const Eigen::Index vertices = shapes[0].cols();
    shape_set set{{static_cast<std::size_t>(vertices)},
                  std::move(names),
                  cell_matrix(3 * vertices, static_cast<Eigen::Index>(shapes.size()))};
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (shapes[i].cols() != vertices)
        throw error("shape '" + set.names[i] + "' has " + std::to_string(shapes[i].cols()) + " vertices, expected " +
                    std::to_string(vertices) + " as '" + set.names[0] + "' has");
      if (!shapes[i].allFinite()) throw error("shape '" + set.names[i] + "' has a vertex that is not finite");
      set.values.col(static_cast<Eigen::Index>(i)) = shapes[i].reshaped().cast<float>();
    }
    return set;
  }
};

static_assert(observation_set<shape_set>);

/// The principal components of shapes.
using shape_basis = pca<lin, vertex_coordinates>;

static_assert(tabulated_basis<shape_basis>);

/// The mean shape.
[[nodiscard]] inline point_columns mean_shape(const shape_basis& basis) {
  return Eigen::Map<const Eigen::Matrix3Xf>(basis.mean().data(), 3, static_cast<Eigen::Index>(basis.mean().size() / 3))
      .cast<double>();
}

/// mu + Q w (Eq. 2): the shape of weights w, whose covariance over the m shapes of the basis is I / m. O(size of the
/// basis x vertices).
[[nodiscard]] inline point_columns shape_of(const shape_basis& basis, const Eigen::VectorXd& weights) {
  const Eigen::VectorXf offsets = basis.components() * weights.cast<float>();
  return mean_shape(basis) + Eigen::Map<const Eigen::Matrix3Xf>(offsets.data(), 3, offsets.size() / 3).cast<double>();
}

/// The squared Mahalanobis distance of weights from the mean: m |w|^2 for a basis of m shapes. Of shapes of the
/// family it is distributed as chi-square of as many degrees of freedom as there are weights (section 2).
[[nodiscard]] inline double squared_mahalanobis(const shape_basis& basis, const Eigen::VectorXd& weights) {
  return static_cast<double>(basis.names().size()) * weights.squaredNorm();
}

/// The fewest components that explain a share of the shapes' variance. Throws gonio::error unless the share is above 0
/// and at most 1.
[[nodiscard]] inline shape_basis explaining(const shape_basis& basis, double share) {
  if (!(share > 0.0 && share <= 1.0))
    throw error("the explained variance must be above 0 and at most 1, not " + std::to_string(share));
  const Eigen::VectorXd& sigma = basis.singular_values();
  const double enough = share * sigma.squaredNorm() * (1.0 - 1e-12);
  std::size_t kept = 0;
  for (double sum = 0.0; kept < basis.size() && sum < enough; ++kept)
    sum += sigma[static_cast<Eigen::Index>(kept)] * sigma[static_cast<Eigen::Index>(kept)];
  return basis.truncated(kept);
}

/// How many functions `with_motion` adds.
inline constexpr Eigen::Index motions = 6;

/// The same basis and, as its last six functions, what a small turn about each axis through the centroid of `shape` and
/// a shift along each does to that shape. Their weights are the turn in radians and the shift in the unit of the mesh,
/// each divided by `freedom`: the larger it is, the less a solver's penalty holds the shape in place.
///
/// What is moved is a shape of the family, not its mean: a turn of the mean differs from one of the shape by a change
/// of shape, and a fit that may turn the mean only ends where the shape would still turn. Throws gonio::error for a
/// shape of another number of vertices.
[[nodiscard]] inline shape_basis with_motion(const shape_basis& basis, const point_columns& shape,
                                             double freedom = 1e3) {
  if (shape.size() != basis.components().rows())
    throw error("a shape of " + std::to_string(shape.cols()) + " vertices is to move with a basis of " +
                std::to_string(basis.components().rows() / 3));
  const auto k = static_cast<Eigen::Index>(basis.size());
  const Eigen::Vector3d centroid = shape.rowwise().mean();
  cell_matrix functions(basis.components().rows(), k + motions);
  functions.leftCols(k) = basis.components();
  for (Eigen::Index vertex = 0; vertex < shape.cols(); ++vertex) {
    const Eigen::Vector3f arm = (shape.col(vertex) - centroid).cast<float>();
    auto rows = functions.block<3, 6>(3 * vertex, k);
    rows << 0, arm.z(), -arm.y(), 1, 0, 0,  // turn x arm, and the shift
        -arm.z(), 0, arm.x(), 0, 1, 0,      //
        arm.y(), -arm.x(), 0, 0, 0, 1;
    rows *= static_cast<float>(freedom);
  }
  Eigen::VectorXd singular_values(k + motions);
  singular_values << basis.singular_values(), functions.rightCols(motions).cast<double>().colwise().norm().transpose();
  Eigen::MatrixXf coefficients = Eigen::MatrixXf::Zero(basis.coefficients().rows(), k + motions);
  coefficients.leftCols(k) = basis.coefficients();
  return shape_basis({basis.cells(), basis.metric(), basis.names(), std::move(singular_values), std::move(functions),
                      basis.mean(), std::move(coefficients), basis.explained_variance(), basis.source()});
}

}  // namespace gonio
