#pragma once
/// Criteria for a set of measurements, computed from a basis' rows at the measurements: the condition number (Nielsen
/// et al. 2015, doi:10.1145/2816795.2818085) and two criteria of Bayesian experimental design. Another criterion,
/// `expected_error` (Xu et al. 2016, doi:10.1145/2980179.2982396), has its own header.

#include <gonio/solve/default_eta.hpp>

#include <Eigen/Core>

#include <concepts>

namespace gonio::design {

/// A number computed from the values of k components at n measurements, n x k. Smaller is better. It must not depend on
/// the order of the rows.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/design/criterion_of_plan.hpp>
/// #include <gonio/design/search.hpp>
/// #include <gonio/io/materials/prior.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const auto prior = gonio::io::read_prior("materials.prior");
///   const gonio::design::point_geometry points(prior.cells());
///   const gonio::design::criterion_of_plan condition{prior, points, gonio::design::condition_number{}};
///   const auto five = gonio::design::grow_and_descend(points, condition, 5);
///   std::printf("the condition number of 5 samples is %g\n", five.value);
/// }
/// ```
/// With a model of your own, the inverse of the size of the rows:
/// ```cpp
/// #include <gonio/design/design_criterion.hpp>
///
/// #include <cstdio>
///
/// struct inverse_size {
///   double operator()(const Eigen::MatrixXd& components) const { return 1.0 / components.squaredNorm(); }
/// };
/// static_assert(gonio::design::design_criterion<inverse_size>);
///
/// int main() { std::printf("%g\n", inverse_size{}(Eigen::MatrixXd::Identity(5, 5))); }
/// ```
template <class Criterion>
concept design_criterion = requires(const Criterion& criterion, const Eigen::MatrixXd& components) {
  { criterion(components) } -> std::convertible_to<double>;
};

/// The ratio of the largest to the smallest of min(n, k) singular values (Nielsen et al. 2015, Eq. 8). For one
/// measurement this ratio is always 1; the criterion is then the inverse of the row's length (section 4, after Ipsen
/// and Wentworth 2014). Infinity if the smallest singular value is a rounding error, about 1e-13 of the largest or less
/// (`singular_value_rounding`). O(n k min(n, k)).
struct condition_number {
  [[nodiscard]] double operator()(const Eigen::MatrixXd& components) const;
};
static_assert(design_criterion<condition_number>);

namespace detail {

void require_positive_eta(double eta);

}  // namespace detail

/// D-optimality. Tikhonov's penalty eta is the prior c ~ N(0, s^2 / eta I) of weights c, if measurements have noise of
/// variance s^2. After measurements with rows R, the covariance of the weights is s^2 (R'R + eta I)^-1. The criterion
/// is the logarithm of the volume of this covariance's ellipsoid, relative to the prior's (Chaloner and Verdinelli
/// 1995, "Bayesian Experimental Design: A Review", doi:10.1214/ss/1177009939). O(n^2 k).
class d_optimality {
 public:
  /// Throws gonio::error unless eta is positive.
  explicit d_optimality(double eta = default_eta) : eta_(eta) { detail::require_positive_eta(eta); }

  [[nodiscard]] double operator()(const Eigen::MatrixXd& components) const;

 private:
  double eta_;
};
static_assert(design_criterion<d_optimality>);

/// A-optimality: the expected squared error, for the covariance of the weights c that `d_optimality` uses. The error of
/// the reconstruction Q c is summed over all cells, so each weight counts by its effect on the cells. The value is
/// relative to the error without measurements. O(n^2 k).
class a_optimality {
 public:
  /// `energies`: |Q e_j|^2 of each component j, which for scaled principal components is the singular value squared.
  /// Throws gonio::error unless eta is positive and the energies are finite, not negative, and not all zero.
  explicit a_optimality(Eigen::VectorXd energies, double eta = default_eta);

  [[nodiscard]] double operator()(const Eigen::MatrixXd& components) const;

 private:
  Eigen::VectorXd energies_;
  double eta_;
};
static_assert(design_criterion<a_optimality>);

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/design_criterion.ipp>
#endif
