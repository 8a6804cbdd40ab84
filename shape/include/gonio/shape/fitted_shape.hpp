#pragma once
/// Fits shapes to some of their vertices, with the equations and solvers of BRDF reconstruction. "Anatomically correct
/// surface recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), Eq. 4-7.
///
/// Let Q1 and Q2 be the rows of Q (Eq. 2) for the missing and the known vertices, of m shapes. Then S22 = Q2 Q2' / m
/// and S12 = Q1 Q2' / m. The paper's E{s1|y2} = mu1 + S12 P L^-1 P' (s2 - mu2) therefore equals mu1 + Q1 w. Here w is
/// the vector of least norm that solves Q2 w = s2 - mu2 in the k largest singular directions; `truncated_svd` finds it.

#include <gonio/core/parallel.hpp>
#include <gonio/estimate/basis_equations.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/shape/shape_basis.hpp>
#include <gonio/solve/solver.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio::shape {

/// Vertices with known positions: their numbers, and a column of `positions` for each of them.
///
/// A scan determines a vertex only across the surface, because the vertex can slide along it. Each vertex may therefore
/// have a unit normal; squared residuals along the surface then have the weight `tangential`. The paper has no normals.
struct vertex_observations {
  std::vector<Eigen::Index> vertices;
  point_columns positions;
  point_columns normals = {};    ///< empty, or a unit normal for each vertex
  double tangential = 0.01;      ///< used with normals
  Eigen::VectorXd weights = {};  ///< empty, or the weight of each squared residual, not negative

  /// Returns the marked vertices of a shape.
  [[nodiscard]] static vertex_observations marked(const point_columns& shape, const std::vector<bool>& known);
};

/// Returns a mark for each vertex: true if it is known.
[[nodiscard]] std::vector<bool> marks_of(const vertex_observations& known, Eigen::Index vertices);

/// Returns three samples for each known vertex: its coordinates along its normal and two tangents, or x, y and z if it
/// has no normal. Throws gonio::error if no vertex is known, if one does not exist or is not finite, if a normal does
/// not have length 1, or if the numbers of positions, normals or weights differ from the number of vertices.
[[nodiscard]] located_samples locate_vertices(const vertex_coordinates& coordinates, const vertex_observations& known);

/// A shape given by the weights of a basis, with the solver's report.
class fitted_shape {
 public:
  /// Throws gonio::error unless there is one weight for each function.
  fitted_shape(shape_basis basis, solution found);

  [[nodiscard]] const shape_basis& functions() const noexcept { return basis_; }
  [[nodiscard]] const Eigen::VectorXd& weights() const noexcept { return weights_; }
  [[nodiscard]] const solve_report& report() const noexcept { return report_; }

  [[nodiscard]] point_columns vertices() const { return shape_of(basis_, weights_); }

  /// Returns one vertex. O(size of the basis).
  [[nodiscard]] Eigen::Vector3d vertex(Eigen::Index number) const;

 private:
  shape_basis basis_;
  Eigen::VectorXd weights_;
  solve_report report_;
};

/// Returns the shape with the weights that a solver finds for known vertices. With `truncated_svd` it is the
/// conditional expectation of Eq. 7. Costs the solver plus O(vertices x size of the basis). Throws gonio::error for
/// vertices that `locate_vertices` refuses, or if the solver fails.
///
/// ```cpp
/// const auto whole = gonio::shape::fit_shape(shapes, gonio::truncated_svd{0.99}, known).vertices();
/// ```
template <solver Solver>
[[nodiscard]] fitted_shape fit_shape(const shape_basis& basis, const Solver& solver, const vertex_observations& known,
                                     thread_count threads = {}) {
  const basis_equations equations(basis, locate_vertices(basis.cells(), known), threads);
  return {basis, equations.solve(solver)};
}

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/fitted_shape.ipp>
#endif
