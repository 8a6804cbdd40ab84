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

/// D x <= d, E x = e and, if `non_negative`, x >= 0, which costs no rows. Either part may be empty.
struct linear_constraints {
  Eigen::MatrixXd D = {};  ///< inequalities x k
  Eigen::VectorXd d = {};  ///< inequalities
  Eigen::MatrixXd E = {};  ///< equalities x k
  Eigen::VectorXd e = {};  ///< equalities
  bool non_negative = false;

  /// Throws gonio::error unless the sizes match each other and `unknowns` and all numbers are finite, naming the row.
  void require_consistent(Eigen::Index unknowns) const;

  /// The constraints as their own policy (`constraint_policy`): the same for every problem. Throws as
  /// `require_consistent`.
  [[nodiscard]] linear_constraints operator()(Eigen::Index unknowns) const;

 private:
  static void require_consistent(const Eigen::MatrixXd& rows, const Eigen::VectorXd& right, Eigen::Index unknowns,
                                 const std::string& kind);
};

/// Makes the constraints of a problem with so many unknowns. A policy all of whose constraints include x >= 0 says so
/// by `static constexpr bool non_negative = true;`.
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

/// x >= 0 and the weights sum to 1.
struct convex_weights {
  static constexpr bool non_negative = true;
  [[nodiscard]] linear_constraints operator()(Eigen::Index unknowns) const;
};

static_assert(constraint_policy<linear_constraints> && constraint_policy<non_negative_weights> &&
              constraint_policy<convex_weights>);

/// Does a policy promise x >= 0 to the compiler? (linear_constraints has the flag at run time only: it does not.)
template <class Policy>
inline constexpr bool promises_non_negative = false;
template <class Policy>
requires requires { typename std::bool_constant<Policy::non_negative>; }
inline constexpr bool promises_non_negative<Policy> = Policy::non_negative;

/// The Lagrange multipliers of the rows: at the optimum Q x - m + D' `inequality` + E' `equality` is zero, or not
/// negative where x >= 0 holds with equality.
struct constraint_multipliers {
  Eigen::VectorXd inequality;  ///< >= 0, as many as rows of D
  Eigen::VectorXd equality;    ///< of any sign, as many as rows of E
};

/// What one unit of each weight is measured by: sqrt(Q_jj), the length of its column. A column of zeros has the size of
/// its coefficients in the rows instead, relative to the rows' largest coefficient per unit of the other weights; 1
/// without any. O(k rows).
[[nodiscard]] Eigen::VectorXd column_lengths(const normal_equations& normal, const linear_constraints& constraints);

namespace detail {

/// One row at x, in units in which the columns have length 1.
struct judged_row {
  double activity = 0.0;  ///< D_i x
  double largest = 0.0;   ///< |D_ij| / length_j

  judged_row(const Eigen::VectorXd& row, const Eigen::VectorXd& lengths, const Eigen::Ref<const Eigen::VectorXd>& x);
  /// `size` is the largest |x_j| length_j.
  [[nodiscard]] double relative_slack(double bound, double size) const;
};

/// The gradient Q x - m + D' inequality + E' equality of the Lagrangian.
[[nodiscard]] scaled_gradient lagrangian_gradient(const normal_equations& normal, Eigen::Index right_hand_side,
                                                  const Eigen::Ref<const Eigen::VectorXd>& x,
                                                  const linear_constraints& constraints,
                                                  const constraint_multipliers& multipliers);

}  // namespace detail

/// The KKT conditions of min 1/2 x'Q x - m'x under linear constraints for one right-hand side: the worst of
/// - stationarity of the Lagrangian (only the sign of its gradient where x_j = 0 under x >= 0), in units of
///   `column_lengths` and relative to the largest sum of terms in it, as in `scaled_gradient`, or to the largest weight
///   in these units, if that is more, as it can be where columns are zero;
/// - each row's violation, relative to |d_i| and the size of its coefficients times that of the weights;
/// - a negative multiplier of an inequality, relative to the gradient's terms;
/// - complementarity: the smaller of an inequality's relative multiplier and its relative slack.
/// With x >= 0 alone it is `kkt_violation(normal, x, 0.0, sign_rule::non_negative)`. O(k (r + s)) for r rows and s
/// weights that are not zero.
[[nodiscard]] double kkt_violation(const normal_equations& normal, Eigen::Index right_hand_side,
                                   const Eigen::Ref<const Eigen::VectorXd>& x, const linear_constraints& constraints,
                                   const constraint_multipliers& multipliers);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/linear_constraints.ipp>
#endif
