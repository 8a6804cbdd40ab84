#pragma once
/// The active-set method for min 1/2 |A x - b|^2 + lambda |x|_1, with or without x >= 0, on the rows: Lawson and
/// Hanson, Solving Least Squares Problems, 1974 (doi:10.1137/1.9781611971217), algorithm NNLS, with a penalty and
/// iterative refinement (Bjorck, BIT 7, 1967, doi:10.1007/BF01939321). It never squares the condition number. Solvers
/// that do fall back to it.

#include <gonio/solve/iteration.hpp>
#include <gonio/solve/kkt.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio {

/// As in `active_set`, one column enters at a time. A step is kept if it lowers the objective, whose change is computed
/// directly. Otherwise the column is barred until another has entered. Hence no passive set recurs. A column that
/// depends on the passive ones up to 3e-11 of its length stays out. Its part of the gradient is at most that share of
/// |b|, and weights larger than 3e10 |b| have no digits left for the data.
///
/// A step costs O(n p^2) for n rows and p passive columns, and the same again for each column that leaves. Reduce the
/// number of rows first (`detail::triangular_equations`).
class row_active_set {
 public:
  /// Takes n rows by k columns, n right-hand values, and the penalty on |x|_1, >= 0. O(n k).
  row_active_set(Eigen::MatrixXd rows, Eigen::VectorXd right, double lambda, sign_rule signs);

  /// Lets one column enter and settles.
  void step();

  [[nodiscard]] bool converged() const noexcept { return entering_ < 0; }
  [[nodiscard]] Eigen::VectorXd result() const { return state_.x.cwiseProduct(unit_); }

 private:
  struct state {
    std::vector<Eigen::Index> passive;
    Eigen::VectorXd sign;    // 0: not passive
    Eigen::VectorXd x;       // for columns of length about 1, and a right-hand side of norm about 1
    Eigen::VectorXd misfit;  // b - A x
  };
  struct passive_optimum;

  [[nodiscard]] Eigen::MatrixXd columns_of(const std::vector<Eigen::Index>& passive) const;

  /// Returns the optimum of the passive columns, if these are independent.
  [[nodiscard]] passive_optimum optimum() const;

  /// Moves to the optimum as in `active_set`. Returns false if the passive columns depend on each other.
  [[nodiscard]] bool settle();

  /// Returns false if only rounding keeps the column from entering.
  [[nodiscard]] bool enter(Eigen::Index column);
  [[nodiscard]] bool exchange(Eigen::Index column);

  void drop(std::ptrdiff_t position);
  void choose_entering();

  /// Returns the change of the objective by a step from `before`.
  [[nodiscard]] double change_since(const state& before, const Eigen::VectorXd& descent) const;

  Eigen::MatrixXd columns_;  // scaled by powers of two to lengths in [1/2, 1)
  Eigen::VectorXd right_, unit_, penalty_;
  sign_rule signs_;
  state state_;
  Eigen::VectorXd descent_;  // A'(b - A x)
  std::vector<bool> barred_;
  Eigen::Index entering_ = -1;
};
static_assert(solver_iteration<row_active_set>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/row_active_set.ipp>
#endif
