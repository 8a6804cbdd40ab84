#pragma once
/// The dual active-set method for strictly convex quadratic programs: Goldfarb and Idnani, Mathematical Programming 27,
/// 1983 (doi:10.1007/BF02591962). Active bounds are not rows of the linear systems: their weights are removed from the
/// systems.

#include <gonio/solve/compensated.hpp>
#include <gonio/solve/growing_cholesky.hpp>
#include <gonio/solve/iteration.hpp>
#include <gonio/solve/working_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// Minimises 1/2 y'(G + shift I) y - q'y under the constraints of a program. Each point is optimal for its working set,
/// a subset of the constraints. A step adds the most violated constraint and drops constraints that prevent it from
/// holding; the objective rises.
///
/// Adding or dropping one constraint costs O(k p + p^2 + w p^2 + w^2 p) for k weights, p of them free, and w active
/// rows.
class dual_active_set {
 public:
  using vector = Eigen::VectorXd;

  /// Starts with the constraints of `start` as equations, except those whose multipliers have the wrong sign. If
  /// `start` is empty, starts without inequalities, like Goldfarb and Idnani. Keeps a reference to `program`; `rhs` is
  /// q of the objective.
  dual_active_set(const scaled_program& program, vector rhs, const active_constraints& start = {}, double shift = 0.0);

  /// Returns the optimum for the active constraints of `neighbour`, without its shift. Changes only free weights with
  /// independent columns; the active constraints stay.
  [[nodiscard]] static dual_active_set polished(const dual_active_set& neighbour, vector rhs);

  /// Adds one constraint. Throws gonio::error if the constraints contradict each other.
  void step();

  [[nodiscard]] bool converged() const noexcept { return singular_ || violated_ < 0; }
  /// Returns true if the method ended because the columns of the free weights depend on each other.
  [[nodiscard]] bool singular() const noexcept { return singular_; }

  /// Returns the number of constraints added and dropped, including corrections of the start.
  [[nodiscard]] int changes() const noexcept { return changes_; }

  /// Returns x = S^-1 y.
  [[nodiscard]] vector result() const { return program_.weights(y_); }
  [[nodiscard]] const vector& scaled_weights() const noexcept { return y_; }
  [[nodiscard]] constraint_multipliers multipliers() const { return program_.multipliers(row_multiplier_); }

  [[nodiscard]] active_constraints active() const;

 private:
  // A violation or a multiplier below this share of `terms` counts as rounding.
  static constexpr double rounding = 1e-13;
  // If a violation is below this share of `terms`, the solution is refined before the violation counts.
  static constexpr double small_violation = 1e-9;

  // The direction of a step. (Constraints are numbered: bounds from 0, rows from k.)
  struct direction {
    vector z;           // change of the free weights
    vector row_rate;    // decrease of each active row's multiplier
    vector bound_rate;  // decrease of each active bound's multiplier
    double slope = 0.0;
    bool dependent = false;
  };
  struct half_space {  // the points y with normal'y >= bound
    vector normal;
    double bound = 0.0;
  };
  struct obstacle {
    Eigen::Index constraint = -1;
    double length = std::numeric_limits<double>::infinity();
  };

  dual_active_set(const scaled_program& program, vector rhs, double shift);

  [[nodiscard]] bool is_row(Eigen::Index constraint) const { return constraint >= program_.unknowns(); }
  [[nodiscard]] bool is_equality(Eigen::Index constraint) const {
    return is_row(constraint) && constraint - program_.unknowns() < program_.equalities;
  }

  void adopt(const active_constraints& start);

  /// Moves to the optimum of the working set. Drops constraints until all multipliers have the right sign.
  void settle();

  void resolve();

  void advance(const vector& free_part, double free_length, const vector& row_part, double row_length);

  /// Computes the multipliers of the bounds: the gradient of the Lagrangian, which is zero for free weights.
  void update_bound_multipliers();

  /// Returns the size of the terms of the gradient that cancel each other.
  [[nodiscard]] double terms() const;

  /// Drops the constraint whose multiplier has the wrong sign by the largest amount. Returns true if there was such a
  /// constraint. Ends the method if the constraint cannot be dropped because its column depends on the free columns.
  [[nodiscard]] bool drop_wrong_sign();

  /// Chooses the most violated constraint, equations first.
  void choose_violated();

  [[nodiscard]] double violation(Eigen::Index constraint) const;

  /// Goldfarb and Idnani's step 2: moves towards the constraint as far as the multipliers of the active constraints
  /// allow, drops the constraint that limits the move, and repeats until the new constraint holds.
  void add(Eigen::Index constraint);

  /// Returns a constraint as a half space; for an equation, the half space that does not contain y.
  [[nodiscard]] half_space half_space_of(Eigen::Index constraint) const;

  [[nodiscard]] direction direction_towards(const vector& normal) const;

  /// Returns the active inequality whose multiplier reaches zero first in a direction.
  [[nodiscard]] obstacle first_obstacle(const direction& way) const;

  void activate(Eigen::Index constraint);

  [[nodiscard]] bool drop(Eigen::Index constraint);

  /// Replaces the bound `dropped` by `added`, if dropping alone would make the free columns dependent. Then y moves
  /// along the null direction of G until `added` holds, which changes no multiplier. Gives up if `added` is a row or if
  /// a row is active, because the row might not determine that direction.
  void exchange(Eigen::Index added, Eigen::Index dropped);

  /// Handles a constraint that the active constraints forbid: its normal is a combination of their normals, and
  /// dropping an inequality does not help. If the right-hand sides contradict each other by more than rounding, no
  /// solution exists (Farkas): throws gonio::error. Otherwise tolerates the violation.
  void tolerate(Eigen::Index constraint, double bound, const direction& way);

  [[nodiscard]] std::string describe(Eigen::Index constraint) const;

  void give_up() noexcept { singular_ = true; }

  /// Refines iteratively with residuals in twice the precision, as long as that helps.
  void refine();

  [[nodiscard]] double gradient_misfit(Eigen::Index j) const;
  [[nodiscard]] double row_misfit(Eigen::Index i) const;

  const scaled_program& program_;
  vector rhs_;
  double rhs_size_;  // largest entry of the right-hand side
  double shift_;
  working_set set_;
  vector y_, bound_multiplier_, row_multiplier_;
  std::vector<bool> tolerated_;  // violated only by rounding: no step can repair these
  Eigen::Index violated_ = -1;
  int changes_ = 0;
  bool singular_ = false;
};
static_assert(solver_iteration<dual_active_set>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/dual_active_set.ipp>
#endif
