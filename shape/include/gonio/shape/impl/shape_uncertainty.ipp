#pragma once
/// Bodies of shape/shape_uncertainty.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/probability.hpp>
#include <gonio/estimate/basis_equations.hpp>
#include <gonio/shape/fitted_shape.hpp>
#include <gonio/shape/shape_uncertainty.hpp>
#include <gonio/solve/any_solver.hpp>
#include <gonio/solve/dense.hpp>
#include <gonio/solve/least_squares_problem.hpp>

#include <Eigen/Core>

#include <algorithm>

namespace gonio::shape {

GONIO_INLINE shape_uncertainty::shape_uncertainty(const fitted_shape& fit, const vertex_observations& known,
                                                  const any_solver& solver)
    : functions_(fit.functions().components()) {
  const shape_basis& basis = fit.functions();
  find(basis_equations(basis, locate_vertices(basis.cells(), known)).problem(), fit.weights(),
       static_cast<double>(basis.names().size()), solver);
}

GONIO_INLINE shape_uncertainty::shape_uncertainty(const shape_with_motion& functions, const Eigen::VectorXd& weights,
                                                  const vertex_observations& known, const any_solver& solver)
    : functions_(functions.functions()) {
  find(basis_equations(functions, locate_vertices(functions.cells(), known)).problem(), weights,
       static_cast<double>(functions.shape().names().size()), solver);
}

GONIO_INLINE void shape_uncertainty::find(const least_squares_problem& problem, const Eigen::VectorXd& weights,
                                          double m, const any_solver& solver) {
  const row_matrix rows = problem.rows();
  const Eigen::MatrixXd seen = solver.solve(least_squares_problem(rows, rows, problem.weights())).weights;
  const Eigen::MatrixXd transposed = seen.transpose();
  unseen_ = -0.5 * (seen + transposed);
  for (Eigen::Index i = 0; i < unseen_.rows(); ++i) unseen_(i, i) += 1.0;
  published_scale_ = 1.0 / m;
  // At least 3: with as many directions as shapes, nothing would be left to estimate the directions' own uncertainty.
  degrees_of_freedom_ = std::max(m - 1.0 - seen.trace(), 3.0);
  scale_ = (1.0 + 1.0 / m + weights.squaredNorm()) / degrees_of_freedom_;
}

GONIO_INLINE double shape_uncertainty::squared_radius(double share) const {
  const double left = degrees_of_freedom_ - 2.0;
  return 3.0 * degrees_of_freedom_ / left * f_quantile(share, 3.0, left);
}

GONIO_INLINE Eigen::Matrix3d shape_uncertainty::unscaled(Eigen::Index vertex) const {
  const Eigen::MatrixXd columns = functions_.middleRows(3 * vertex, 3).cast<double>().transpose(),
                        unseen = product(unseen_, columns);
  Eigen::Matrix3d covariance;
  for (Eigen::Index j = 0; j < 3; ++j)
    for (Eigen::Index i = 0; i < 3; ++i) covariance(i, j) = columns.col(i).dot(unseen.col(j));
  return covariance;
}

}  // namespace gonio::shape
