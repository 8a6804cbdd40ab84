#pragma once
/// Non-negative least squares by the active-set method of Lawson and Hanson (1974, doi:10.1137/1.9781611971217) on the
/// normal equations (Bro and de Jong 1997, doi:10.1002/(SICI)1099-128X(199709/10)11:5<393::AID-CEM483>3.0.CO;2-L). With
/// measured materials as columns, the result is the initial estimate of Noell et al. 2014.

#include <gonio/solve/active_set.hpp>

namespace gonio {

/// Minimises |W^(1/2) (A x - b)|^2 over x >= 0. Throws gonio::error if no optimum can be certified; certification uses
/// the rows if there are any (solve/signed_solution.hpp).
///
/// ```cpp
/// const gonio::solution found = gonio::nnls().solve(problem);   // a least_squares_problem, or normal_equations
/// ```
class nnls {
 public:
  static constexpr bool non_negative = true;
  using iteration = active_set<sign_rule::non_negative>;

  [[nodiscard]] solution solve(const least_squares_problem& problem) const;
  [[nodiscard]] solution solve(const normal_equations& normal) const;
};

static_assert(normal_solver<nnls>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/nnls.ipp>
#endif
