#pragma once
/// Non-negative least squares by block principal pivoting: Portugal, Judice and Vicente, Math. Comp. 63, 1994; Kim and
/// Park, SIAM J. Sci. Comput. 33, 2011, algorithm 2.

#include <gonio/solve/active_set.hpp>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace gonio {

/// Guesses which weights are free, solves for them, and exchanges all that came out with the wrong sign at once, a
/// weight below zero or a gradient that points inside: few steps, each with a factorisation of its own, O(p^3 / 3 + k
/// p). Where exchanging everything does not reduce the number of wrong signs for three steps only the last wrong one is
/// exchanged (Murty's rule), which cannot cycle where the free columns are independent. Once no sign is wrong, or after
/// 3 k + 20 steps of what cycles, `active_set` finishes from there.
class block_pivoting {
 public:
  /// Keeps a reference to `normal`.
  block_pivoting(const normal_equations& normal, Eigen::Index right_hand_side);

  /// Exchanges, or finishes.
  void step();

  [[nodiscard]] bool converged() const noexcept { return finished_; }
  [[nodiscard]] const Eigen::VectorXd& weights() const noexcept { return x_; }

 private:
  void exchange();

  void finish();

  void solve_free();

  void find_wrong(const Eigen::VectorXd& gradient);

  const normal_equations& normal_;
  Eigen::Index right_hand_side_;
  Eigen::VectorXd rhs_;
  Eigen::VectorXd x_;
  std::vector<bool> free_;
  std::vector<Eigen::Index> wrong_;
  std::ptrdiff_t fewest_wrong_;
  int chances_ = 3;
  Eigen::Index steps_ = 0;
  bool finished_ = false;
};

/// Minimises |W^(1/2) (A x - b)|^2 over x >= 0, as `nnls` does, in fewer and larger steps; docs/solvers.md has both
/// measured. Throws gonio::error as `nnls` does.
class nnls_block_pivoting {
 public:
  static constexpr bool non_negative = true;
  using iteration = block_pivoting;

  [[nodiscard]] solution solve(const least_squares_problem& problem) const;
  [[nodiscard]] solution solve(const normal_equations& normal) const;
};

static_assert(normal_solver<nnls_block_pivoting>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/nnls_block_pivoting.ipp>
#endif
