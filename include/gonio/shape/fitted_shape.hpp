#pragma once
/// Shapes from some of their vertices, by the estimator that completes BRDFs: `decomposition` over the coordinates of
/// vertices. "Anatomically correct surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), Eq. 4-7.
///
/// With the rows Q2 of the known vertices and m shapes, S22 = Q2 Q2' / m and S12 = Q1 Q2' / m, so that the paper's
/// E{s1|y2} = mu1 + S12 P L^-1 P' (s2 - mu2) is mu1 + Q1 w for the w of least norm with Q2 w = s2 - mu2 in the k
/// largest singular directions: what `truncated_svd` finds.

#include <gonio/core/parallel.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/shape/shape_basis.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio::shape {

/// Vertices whose positions are known, by number: a column of `positions` for each.
///
/// A place found on a scan is known across the surface only: along it nothing tells one place from the next. So there
/// may be a unit normal for each, and what is known along the surface then counts less, `tangential` times the square
/// of what is off. The paper has no normals: a place counts in full.
struct vertex_observations {
  std::vector<Eigen::Index> vertices;
  point_columns positions;
  point_columns normals = {};    ///< none, or one for each
  double tangential = 0.01;      ///< if there are normals
  Eigen::VectorXd weights = {};  ///< none, or how much the square of what is off at each counts, not negative

  /// Those of a shape whose mark is set.
  [[nodiscard]] static vertex_observations marked(const point_columns& shape, const std::vector<bool>& known);
};

/// Which of so many vertices are known.
[[nodiscard]] std::vector<bool> marks_of(const vertex_observations& known, Eigen::Index vertices);

/// What `decomposition` measures of a shape. Throws gonio::error if no vertex is known, one does not exist or is not
/// finite, or for another number of positions or normals.
[[nodiscard]] located_samples locate_samples(const vertex_coordinates& coordinates, const vertex_observations& known,
                                             thread_count /*threads*/ = {});

/// A shape held as the weights of a basis, and what the solver said about it.
class fitted_shape {
 public:
  /// Throws gonio::error unless there is one weight for each function.
  fitted_shape(shape_basis basis, solution found);

  [[nodiscard]] const shape_basis& functions() const noexcept { return basis_; }
  [[nodiscard]] const solution& found() const noexcept { return found_; }
  [[nodiscard]] Eigen::VectorXd weights() const { return found_.weights.col(0); }

  /// All vertices.
  [[nodiscard]] point_columns vertices() const { return shape_of(basis_, weights()); }

  /// One vertex. O(size of the basis).
  [[nodiscard]] Eigen::Vector3d vertex(Eigen::Index number) const;

 private:
  shape_basis basis_;
  solution found_;
};

static_assert(measured_over<vertex_observations, vertex_coordinates>);

}  // namespace gonio::shape

namespace gonio {

/// `decomposition{shapes, truncated_svd{0.99}}.fit(known)` is a shape.
template <>
struct fit_over<shape::vertex_coordinates> {
  template <class Basis>
  using type = shape::fitted_shape;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/fitted_shape.ipp>
#endif
