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
/// For m shapes, the weights have the covariance I / m. Known vertices reduce it to (I - R) / m, where R is the
/// solver's response to weights seen through the known rows: w in, R w out. For `truncated_svd`, R is the projection on
/// the kept directions, and this is S11 - S12 P L^-1 P' S21. For `tikhonov` it is the posterior.
///
/// This holds for large m. A family of 40 directions learned from 160 shapes is itself uncertain. The covariance of a
/// new shape is therefore larger by m / (m - 1 - k) (1 + 1 / m + |w|^2), with k = trace R (the predictive distribution
/// of multivariate regression; Mardia, Kent and Bibby, "Multivariate Analysis", 1979, chapter 6), and its tails are
/// heavier than normal: `squared_radius`. `as_published` omits this factor.
class shape_uncertainty {
 public:
  /// For a fit by `solver` to these known vertices: O(3 known x k^2) for a basis of k components. Throws gonio::error
  /// for known vertices that `fit_shape` refuses.
  shape_uncertainty(const fitted_shape& fit, const vertex_observations& known, const any_solver& solver);
  /// Likewise for a shape that may move, with the weights of all its functions.
  shape_uncertainty(const shape_with_motion& functions, const Eigen::VectorXd& weights,
                    const vertex_observations& known, const any_solver& solver);

  /// Returns the squared radius such that a vertex is in the ellipsoid d' covariance^-1 d <= squared_radius(share)
  /// about its prediction with this probability: 3 F with 3 and m - 3 - k degrees of freedom, which for many shapes is
  /// chi-square with 3.
  [[nodiscard]] double squared_radius(double share) const;

  /// Returns the 3 x 3 covariance of one vertex's position. O(k^2).
  [[nodiscard]] Eigen::Matrix3d covariance(Eigen::Index vertex) const { return scale_ * unscaled(vertex); }
  /// Returns it without the factor for the number of shapes.
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
