#pragma once
/// The uncertainty of a predicted shape's vertices: V{s1|s2} of "Anatomically correct surface recovery" (Nielsen,
/// doctoral thesis, DTU 2016, contribution C.V, Eq. 4), for the solver that predicts them.

#include <gonio/shape/fitted_shape.hpp>
#include <gonio/shape/shape_basis.hpp>
#include <gonio/shape/shape_with_motion.hpp>
#include <gonio/solve/any_solver.hpp>

#include <Eigen/Core>

namespace gonio::shape {

/// The covariance of a shape's vertices given the known ones.
///
/// The weights of a basis of m shapes have the covariance I / m. Known vertices reduce it to (I - R) / m: R w are the
/// weights that the solver finds for the known vertices of the shape with weights w. For `truncated_svd`, R projects on
/// the kept directions, and the vertices' covariance is S11 - S12 P L^-1 P' S21. For `tikhonov` it is the covariance of
/// the posterior.
///
/// This holds for large m. A basis of 40 components learned from 160 shapes is itself uncertain. The covariance of a
/// new shape with weights w is therefore larger by m / (m - 1 - k) (1 + 1 / m + |w|^2), with k = trace R (the
/// predictive distribution of multivariate regression; Mardia, Kent and Bibby, "Multivariate Analysis", 1979, chapter
/// 6). Its tails are heavier than normal; `squared_radius` accounts for them. `as_published` omits this factor.
class shape_uncertainty {
 public:
  /// Takes a fit by `solver` to the vertices `known`. O(3 known x n^2) for a basis of n components. Throws gonio::error
  /// for known vertices that `fit_shape` refuses.
  shape_uncertainty(const fitted_shape& fit, const vertex_observations& known, const any_solver& solver);
  /// Takes the fit of a shape that may also move, as the weights of all its functions.
  shape_uncertainty(const shape_with_motion& functions, const Eigen::VectorXd& weights,
                    const vertex_observations& known, const any_solver& solver);

  /// Returns the squared radius of the ellipsoid d' covariance^-1 d <= squared_radius(share) about a vertex's
  /// prediction that contains the vertex with probability `share`: 3 (m - 1 - k) / (m - 3 - k) times the quantile of F
  /// with 3 and m - 3 - k degrees of freedom. For many shapes this is the quantile of chi-square with 3.
  [[nodiscard]] double squared_radius(double share) const;

  /// Returns the 3 x 3 covariance of one vertex's position. O(n^2).
  [[nodiscard]] Eigen::Matrix3d covariance(Eigen::Index vertex) const { return scale_ * unscaled(vertex); }
  /// Returns the covariance without the factor for the number of shapes.
  [[nodiscard]] Eigen::Matrix3d as_published(Eigen::Index vertex) const { return published_scale_ * unscaled(vertex); }

 private:
  [[nodiscard]] Eigen::Matrix3d unscaled(Eigen::Index vertex) const;

  void find(const least_squares_problem& problem, const Eigen::VectorXd& weights, double shapes,
            const any_solver& solver);

  cell_matrix functions_;
  Eigen::MatrixXd unseen_;  // I - R
  double scale_ = 0.0, published_scale_ = 0.0, degrees_of_freedom_ = 0.0;
};

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/shape_uncertainty.ipp>
#endif
