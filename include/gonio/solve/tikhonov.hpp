#pragma once
/// Least squares with a quadratic penalty on the weights (ridge regression).
/// Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 11-12.

#include <gonio/solve/solver.hpp>

namespace gonio {

/// Minimises |W^(1/2) (A x - b)|^2 + eta |x|^2 exactly.
///
/// A wide problem (fewer rows than unknowns) is solved through its n x n dual, x = A~' (A~ A~' + eta I)^-1 b~ with A~ =
/// W^(1/2) A, in O(n^2 k). Any other problem is solved through the k x k normal equations (A~'A~ + eta I) x = A~'b~ in
/// O(n k^2). Both give the same x.
class tikhonov {
 public:
  enum class form { automatic, primal, dual };

  /// Throws gonio::error unless eta is positive and finite. For principal components of m training observations, eta =
  /// m sigma^2, where sigma^2 is the error variance of one row: noise plus model error, in the squared units of the
  /// metric (`eta_of_noise`).
  explicit tikhonov(double eta, form solved_as = form::automatic);

  [[nodiscard]] double eta() const noexcept { return eta_; }

  /// Throws gonio::error if eta is so small that rounding leaves no optimum.
  [[nodiscard]] solution solve(const least_squares_problem& problem) const;
  [[nodiscard]] solution solve(const normal_equations& normal) const;

 private:
  double eta_;
  form form_;
};

static_assert(normal_solver<tikhonov>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/tikhonov.ipp>
#endif
