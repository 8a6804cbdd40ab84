#pragma once
/// Shapes from some of their vertices, by the equations and solvers that complete BRDFs. "Anatomically correct surface
/// recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V), Eq. 4-7.
///
/// With the rows Q2 of the known vertices and m shapes, S22 = Q2 Q2' / m and S12 = Q1 Q2' / m, so that the paper's
/// E{s1|y2} = mu1 + S12 P L^-1 P' (s2 - mu2) is mu1 + Q1 w for the w of least norm with Q2 w = s2 - mu2 in the k
/// largest singular directions: what `truncated_svd` finds.

#include <gonio/core/parallel.hpp>
#include <gonio/estimate/basis_equations.hpp>
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

/// The rows of a shape's basis that known vertices are compared with: three for each, along its axes. Throws
/// gonio::error if no vertex is known, one does not exist or is not finite, or for another number of positions or
/// normals.
[[nodiscard]] located_samples locate_vertices(const vertex_coordinates& coordinates, const vertex_observations& known);

/// A shape held as the weights of a basis, and the solver's report.
class fitted_shape {
 public:
  /// Throws gonio::error unless there is one weight for each function.
  fitted_shape(shape_basis basis, solution found);

  [[nodiscard]] const shape_basis& functions() const noexcept { return basis_; }
  [[nodiscard]] const Eigen::VectorXd& weights() const noexcept { return weights_; }
  [[nodiscard]] const solve_report& report() const noexcept { return report_; }

  /// All vertices.
  [[nodiscard]] point_columns vertices() const { return shape_of(basis_, weights_); }

  /// One vertex. O(size of the basis).
  [[nodiscard]] Eigen::Vector3d vertex(Eigen::Index number) const;

 private:
  shape_basis basis_;
  Eigen::VectorXd weights_;
  solve_report report_;
};

/// The shape that known vertices belong to, with the weights that a solver finds for them: with `truncated_svd` the
/// conditional expectation of Eq. 7. Cost of the solver plus O(vertices x size of the basis). Throws gonio::error for
/// vertices that `locate_vertices` refuses, or if the solver gives up.
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
