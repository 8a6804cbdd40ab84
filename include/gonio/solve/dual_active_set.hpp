#pragma once
/// The dual active-set method for strictly convex quadratic programs: Goldfarb and Idnani, Mathematical Programming 27,
/// 1983 (doi:10.1007/BF02591962). Active bounds are no rows of the systems: their weights leave them.

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

/// Minimises 1/2 y'(G + shift I) y - q'y under the constraints of a program. Each point is optimal for some of the
/// constraints, those of its working set; a step adds the constraint that it violates most and drops those in the way,
/// and the objective rises.
///
/// Adding or dropping one constraint costs O(k p + p^2 + w p^2 + w^2 p) for k weights, p of them free, and w active
/// rows.
class dual_active_set {
 public:
  using vector = Eigen::VectorXd;

  /// Starts with the constraints of `start` as equations, without those whose multipliers have the wrong sign: without
  /// inequalities if there are none, as Goldfarb and Idnani do. Keeps a reference to `program`; `rhs` is q.
  dual_active_set(const scaled_program& program, vector rhs, const active_constraints& start = {}, double shift = 0.0);

  /// The neighbour, whose G had a shift, without it: solves for the free weights whose columns are independent of one
  /// another, keeps the others as they are and does not change what is active.
  [[nodiscard]] static dual_active_set polished(const dual_active_set& neighbour, vector rhs);

  /// Adds one constraint. Throws gonio::error if the constraints contradict one another.
  void step();

  [[nodiscard]] bool converged() const noexcept { return singular_ || violated_ < 0; }
  /// Is this the end because the columns of the free weights depend on one another?
  [[nodiscard]] bool singular() const noexcept { return singular_; }

  /// How often a constraint has been added or dropped, the start's corrections included.
  [[nodiscard]] int changes() const noexcept { return changes_; }

  /// x = S^-1 y.
  [[nodiscard]] vector result() const { return program_.weights(y_); }
  [[nodiscard]] const vector& scaled_weights() const noexcept { return y_; }
  [[nodiscard]] constraint_multipliers multipliers() const { return program_.multipliers(row_multiplier_); }

  [[nodiscard]] active_constraints active() const;

 private:
  // Relative to `terms` a violation or a multiplier of this size is rounding.
  static constexpr double rounding = 1e-13;
  // Relative to `terms` a solution is refined before a violation below this is believed.
  static constexpr double small_violation = 1e-9;

  // Constraints count from 0 for the bounds and from k for the rows.
  struct direction {
    vector z;           // of the free weights
    vector row_rate;    // what each active row's multiplier loses
    vector bound_rate;  // what each active bound's multiplier loses
    double slope = 0.0;
    bool dependent = false;
  };
  struct half_space {  // normal'y >= bound
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

  /// Moves to the optimum of the working set, and drops constraints until their multipliers have the right sign.
  void settle();

  void resolve();

  void advance(const vector& free_part, double free_length, const vector& row_part, double row_length);

  /// The gradient of the Lagrangian: zero for free weights.
  void update_bound_multipliers();

  /// The size of what cancels in the gradient.
  [[nodiscard]] double terms() const;

  /// Drops the constraint whose multiplier has the wrong sign the most. Returns whether there was one. If it cannot be
  /// dropped because its column depends on the free ones, the method ends.
  [[nodiscard]] bool drop_wrong_sign();

  /// Equations come first.
  void choose_violated();

  [[nodiscard]] double violation(Eigen::Index constraint) const;

  /// Goldfarb and Idnani's step 2: moves towards the constraint, as far as the multipliers of the others allow, drops
  /// the one that stops it, and goes on until it holds.
  void add(Eigen::Index constraint);

  /// The side of an equation on which y is not.
  [[nodiscard]] half_space half_space_of(Eigen::Index constraint) const;

  [[nodiscard]] direction direction_towards(const vector& normal) const;

  /// The active inequality whose multiplier is the first to reach zero.
  [[nodiscard]] obstacle first_obstacle(const direction& way) const;

  void activate(Eigen::Index constraint);

  [[nodiscard]] bool drop(Eigen::Index constraint);

  /// The bound `dropped` would make the free columns dependent: y moves along the direction that G does not see, which
  /// changes no multiplier, until the bound `added` holds and takes its place. With rows it might not see it either.
  void exchange(Eigen::Index added, Eigen::Index dropped);

  /// The active constraints forbid this one: its normal is a combination of theirs, in which none that could give way
  /// helps. If the right-hand sides contradict that beyond rounding it proves that there is no solution (Farkas).
  void tolerate(Eigen::Index constraint, double bound, const direction& way);

  [[nodiscard]] std::string describe(Eigen::Index constraint) const;

  void give_up() noexcept { singular_ = true; }

  /// Iterative refinement with residuals in twice the precision, as long as it helps.
  void refine();

  [[nodiscard]] double gradient_misfit(Eigen::Index j) const;
  [[nodiscard]] double row_misfit(Eigen::Index i) const;

  const scaled_program& program_;
  vector rhs_;
  double rhs_size_;  // the largest of it
  double shift_;
  working_set set_;
  vector y_, bound_multiplier_, row_multiplier_;
  std::vector<bool> tolerated_;  // violated by rounding alone, though nothing can be done about it
  Eigen::Index violated_ = -1;
  int changes_ = 0;
  bool singular_ = false;
};
static_assert(solver_iteration<dual_active_set>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/dual_active_set.ipp>
#endif
