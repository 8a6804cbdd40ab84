#pragma once
/// Linear constraints on the weights of a least-squares problem, and the KKT residual under them.
/// Noell, Koehler and Stricker 2014, Eq. 10.

#include <gonio/core/error.hpp>
#include <gonio/solve/kkt.hpp>
#include <gonio/solve/normal_equations.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <string>
#include <type_traits>

namespace gonio {

/// Constraints D x <= d, E x = e and, if `non_negative`, x >= 0, which needs no rows of D. D and E may be empty.
struct linear_constraints {
  Eigen::MatrixXd D = {};  ///< inequalities x k
  Eigen::VectorXd d = {};  ///< inequalities
  Eigen::MatrixXd E = {};  ///< equalities x k
  Eigen::VectorXd e = {};  ///< equalities
  bool non_negative = false;

  /// Throws gonio::error, naming the row, unless the sizes match each other and the number of unknowns, and all numbers
  /// are finite.
  void require_consistent(Eigen::Index unknowns) const;

  /// Returns these constraints for a problem of `unknowns` unknowns. This makes the class a `constraint_policy`. Throws
  /// as `require_consistent` does.
  [[nodiscard]] linear_constraints operator()(Eigen::Index unknowns) const;

 private:
  static void require_consistent(const Eigen::MatrixXd& rows, const Eigen::VectorXd& right, Eigen::Index unknowns,
                                 const std::string& kind);
};

/// A function that returns the constraints of a problem with a given number of unknowns. A policy whose constraints
/// always include x >= 0 declares `static constexpr bool non_negative = true;`.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/solve/quadratic_program.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::row_matrix rows = gonio::row_matrix::Random(20, 3);
///   const gonio::least_squares_problem problem(rows, rows * Eigen::Vector3d(0.2, 0.3, 0.5));
///   const gonio::solution found = gonio::quadratic_program<gonio::convex_weights>().solve(problem);
///   std::printf("the weights sum to %g\n", found.weights.sum());
/// }
/// ```
/// With a model of your own, weights from 0 to 1:
/// ```cpp
/// #include <gonio/solve/quadratic_program.hpp>
///
/// #include <cstdio>
///
/// struct shares {
///   static constexpr bool non_negative = true;
///   gonio::linear_constraints operator()(Eigen::Index unknowns) const {
///     return {.D = Eigen::MatrixXd::Identity(unknowns, unknowns),
///             .d = Eigen::VectorXd::Ones(unknowns),
///             .non_negative = true};
///   }
/// };
/// static_assert(gonio::constraint_policy<shares>);
///
/// int main() {
///   const gonio::row_matrix rows = gonio::row_matrix::Random(20, 3);
///   const gonio::least_squares_problem problem(rows, rows * Eigen::Vector3d(2, 0.3, -1));
///   std::printf("%g\n", gonio::quadratic_program<shares>().solve(problem).weights(0, 0));
/// }
/// ```
template <class Policy>
concept constraint_policy = requires(const Policy& policy, Eigen::Index unknowns) {
  { policy(unknowns) } -> std::same_as<linear_constraints>;
};

/// x >= 0.
struct non_negative_weights {
  static constexpr bool non_negative = true;
  [[nodiscard]] linear_constraints operator()(Eigen::Index) const { return {.non_negative = true}; }
};

/// The constraints that x >= 0 and that the weights sum to 1.
struct convex_weights {
  static constexpr bool non_negative = true;
  [[nodiscard]] linear_constraints operator()(Eigen::Index unknowns) const;
};

static_assert(constraint_policy<linear_constraints> && constraint_policy<non_negative_weights> &&
              constraint_policy<convex_weights>);

/// True if a policy promises x >= 0 at compile time. False for `linear_constraints`, which has its flag only at run
/// time.
template <class Policy>
inline constexpr bool promises_non_negative = false;
template <class Policy>
requires requires { typename std::bool_constant<Policy::non_negative>; }
inline constexpr bool promises_non_negative<Policy> = Policy::non_negative;

/// The Lagrange multipliers of the rows of D and E. At the optimum, an entry of Q x - m + D' `inequality` + E'
/// `equality` is zero or, where x >= 0 holds with equality, not negative.
struct constraint_multipliers {
  Eigen::VectorXd inequality;  ///< not negative, one for each row of D
  Eigen::VectorXd equality;    ///< of any sign, one for each row of E
};

/// Returns the unit of each weight: sqrt(Q_jj), the length of its column. The unit of a column j of zeros is the
/// largest |D_ij| / s_i over the rows i of D and E, or 1 if that is zero. Here s_i is the largest |D_il| / sqrt(Q_ll)
/// over all columns l that are not zero, or the largest |D_il| if the row has no such column. O(k rows).
[[nodiscard]] Eigen::VectorXd column_lengths(const normal_equations& normal, const linear_constraints& constraints);

namespace detail {

/// A row of the constraints at x, for columns scaled to length 1.
struct judged_row {
  double activity = 0.0;  ///< D_i x
  double largest = 0.0;   ///< the largest |D_ij| / length_j

  judged_row(const Eigen::VectorXd& row, const Eigen::VectorXd& lengths, const Eigen::Ref<const Eigen::VectorXd>& x);
  /// Returns (bound - activity) / (|bound| + largest `size`), where `size` is the largest |x_j| length_j.
  [[nodiscard]] double relative_slack(double bound, double size) const;
};

/// Returns the gradient Q x - m + D' inequality + E' equality of the Lagrangian.
[[nodiscard]] scaled_gradient lagrangian_gradient(const normal_equations& normal, Eigen::Index right_hand_side,
                                                  const Eigen::Ref<const Eigen::VectorXd>& x,
                                                  const linear_constraints& constraints,
                                                  const constraint_multipliers& multipliers);

}  // namespace detail

/// Returns the violation of the KKT conditions of min 1/2 x'Q x - m'x under linear constraints for one right-hand side:
/// the largest of
/// - stationarity of the Lagrangian in units of `column_lengths` (under x >= 0, a positive entry of its gradient where
///   x_j = 0 is no violation), relative to the larger of two numbers: the largest sum of terms as in `scaled_gradient`,
///   and the largest weight in these units;
/// - each row's violation, relative to |d_i| + the largest coefficient times the largest weight in these units;
/// - a negative multiplier of an inequality, relative to the terms of the gradient;
/// - complementarity: the smaller of an inequality's relative multiplier and its relative slack.
/// With x >= 0 alone it equals `kkt_violation(normal, x, 0.0, sign_rule::non_negative)`. O(k (r + s)) for r rows and s
/// nonzero weights.
[[nodiscard]] double kkt_violation(const normal_equations& normal, Eigen::Index right_hand_side,
                                   const Eigen::Ref<const Eigen::VectorXd>& x, const linear_constraints& constraints,
                                   const constraint_multipliers& multipliers);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/linear_constraints.ipp>
#endif
