#pragma once
/// How sure the vertices of a predicted shape are: V{s1|s2} of "Anatomically correct surface recovery" (Nielsen,
/// doctoral thesis, DTU 2016, contribution C.V, Eq. 4), by the solver that predicts them.

#include <gonio/shape/fitted_shape.hpp>
#include <gonio/shape/shape_basis.hpp>
#include <gonio/shape/shape_with_motion.hpp>
#include <gonio/solve/any_solver.hpp>

#include <Eigen/Core>

namespace gonio::shape {

/// The covariance of a shape's vertices given those that are known.
///
/// Of m shapes the weights have the covariance I / m, and known vertices leave (I - R) / m of it, where R is what the
/// solver makes of weights it is shown through the known rows: w in, R w out. That is S11 - S12 P L^-1 P' S21 for
/// `truncated_svd`, whose R is the projection on the kept directions, and the posterior for `tikhonov`.
///
/// This is as if m were large. A family of 40 directions learned from 160 shapes is itself uncertain, so the covariance
/// of a new shape is wider by m / (m - 1 - k) (1 + 1 / m + |w|^2), with k = trace R (the predictive distribution of
/// multivariate regression; Mardia, Kent and Bibby, "Multivariate Analysis", 1979, chapter 6), and its tails are
/// heavier than those of a normal distribution: `squared_radius`. `as_published` leaves this out.
class shape_uncertainty {
 public:
  /// Of a fit by `solver` of these known vertices: O(3 known x k^2) for a basis of k components. Throws gonio::error
  /// for known vertices that `fit_shape` refuses.
  shape_uncertainty(const fitted_shape& fit, const vertex_observations& known, const any_solver& solver);
  /// The same of a shape that may move, with the weights of all its functions.
  shape_uncertainty(const shape_with_motion& functions, const Eigen::VectorXd& weights,
                    const vertex_observations& known, const any_solver& solver);

  /// A vertex is within the ellipsoid d' covariance^-1 d <= squared_radius(share) about where it is predicted with this
  /// probability: 3 F of 3 and m - 3 - k degrees of freedom, which for many shapes is chi-square of 3.
  [[nodiscard]] double squared_radius(double share) const;

  /// 3 x 3, of the position of one vertex. O(k^2).
  [[nodiscard]] Eigen::Matrix3d covariance(Eigen::Index vertex) const { return scale_ * unscaled(vertex); }
  /// The same without what the number of shapes adds.
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
