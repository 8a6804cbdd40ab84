#pragma once
/// The dual active-set method for strictly convex quadratic programs: Goldfarb and Idnani, Mathematical Programming 27,
/// 1983 (doi:10.1007/BF02591962). Active bounds are not rows of the systems: their weights leave the systems.

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
/// a subset of the constraints. A step adds the most violated constraint and drops those in the way, and the objective
/// rises.
///
/// Adding or dropping one constraint costs O(k p + p^2 + w p^2 + w^2 p) for k weights, p of them free, and w active
/// rows.
class dual_active_set {
 public:
  using vector = Eigen::VectorXd;

  /// Starts with the constraints of `start` as equations, except those whose multipliers have the wrong sign. If
  /// `start` is empty, it starts without inequalities, like Goldfarb and Idnani. Keeps a reference to `program`; `rhs`
  /// is q.
  dual_active_set(const scaled_program& program, vector rhs, const active_constraints& start = {}, double shift = 0.0);

  /// Returns the result of `neighbour`, which had a shift, solved again without it. Only free weights with independent
  /// columns change. The active constraints stay.
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
  // A violation or multiplier below this share of `terms` is rounding.
  static constexpr double rounding = 1e-13;
  // Below this share of `terms`, the solution is refined before a violation counts.
  static constexpr double small_violation = 1e-9;

  // Constraints are numbered from 0 for the bounds and from k for the rows.
  struct direction {
    vector z;           // of the free weights
    vector row_rate;    // what the multiplier of each active row loses
    vector bound_rate;  // what the multiplier of each active bound loses
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

  /// Moves to the optimum of the working set. Drops constraints until all multipliers have the right sign.
  void settle();

  void resolve();

  void advance(const vector& free_part, double free_length, const vector& row_part, double row_length);

  /// Computes the gradient of the Lagrangian, which is zero for free weights.
  void update_bound_multipliers();

  /// Returns the size of the terms that cancel in the gradient.
  [[nodiscard]] double terms() const;

  /// Drops the constraint whose multiplier has the wrong sign by the largest amount. Returns whether there was one.
  /// Ends the method if the constraint cannot be dropped because its column depends on the free ones.
  [[nodiscard]] bool drop_wrong_sign();

  /// Chooses the most violated constraint, equations first.
  void choose_violated();

  [[nodiscard]] double violation(Eigen::Index constraint) const;

  /// Goldfarb and Idnani's step 2: moves towards the constraint as far as the multipliers of the others allow, drops
  /// the constraint that limits the move, and repeats until the new constraint holds.
  void add(Eigen::Index constraint);

  /// Returns a constraint as a half space; for an equation, the side on which y is not.
  [[nodiscard]] half_space half_space_of(Eigen::Index constraint) const;

  [[nodiscard]] direction direction_towards(const vector& normal) const;

  /// Returns the active inequality whose multiplier reaches zero first.
  [[nodiscard]] obstacle first_obstacle(const direction& way) const;

  void activate(Eigen::Index constraint);

  [[nodiscard]] bool drop(Eigen::Index constraint);

  /// Replaces the bound `dropped`, which would make the free columns dependent, by `added`. y moves along the null
  /// direction of G, which changes no multiplier, until `added` holds. Only possible without rows, which might not
  /// determine that direction either.
  void exchange(Eigen::Index added, Eigen::Index dropped);

  /// Handles a constraint that the active ones forbid: its normal is a combination of theirs, and dropping an
  /// inequality does not help. If the right-hand sides contradict each other by more than rounding, there is no
  /// solution (Farkas) and it throws. Otherwise the violation is tolerated.
  void tolerate(Eigen::Index constraint, double bound, const direction& way);

  [[nodiscard]] std::string describe(Eigen::Index constraint) const;

  void give_up() noexcept { singular_ = true; }

  /// Refines iteratively with residuals in twice the precision, as long as that helps.
  void refine();

  [[nodiscard]] double gradient_misfit(Eigen::Index j) const;
  [[nodiscard]] double row_misfit(Eigen::Index i) const;

  const scaled_program& program_;
  vector rhs_;
  double rhs_size_;  // its largest entry
  double shift_;
  working_set set_;
  vector y_, bound_multiplier_, row_multiplier_;
  std::vector<bool> tolerated_;  // violated by rounding only, and cannot be repaired
  Eigen::Index violated_ = -1;
  int changes_ = 0;
  bool singular_ = false;
};
static_assert(solver_iteration<dual_active_set>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/dual_active_set.ipp>
#endif
