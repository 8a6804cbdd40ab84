#pragma once
/// The active-set method for min 1/2 |A x - b|^2 + lambda |x|_1, with or without x >= 0, on the rows of A: algorithm
/// NNLS of Lawson and Hanson, Solving Least Squares Problems, 1974 (doi:10.1137/1.9781611971217), with a penalty and
/// iterative refinement (Bjorck, BIT 7, 1967, doi:10.1007/BF01939321). The method never squares the condition number.
/// Solvers that square it use this method if they fail.

#include <gonio/solve/iteration.hpp>
#include <gonio/solve/kkt.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio {

/// As in `active_set`, one column enters at a time. A step is kept if it lowers the objective, whose change is computed
/// directly. Otherwise the column is barred until another has entered. Hence no passive set recurs. A column that
/// depends on the passive columns up to 3e-11 of its length stays out: its part of the gradient is at most 3e-11 |b|,
/// and weights larger than 3e10 |b| would have no digits left for the data.
///
/// A step costs O(n p^2) for n rows and p passive columns, and the same again for each column that leaves. Reduce the
/// number of rows first (`detail::triangular_equations`).
class row_active_set {
 public:
  /// Takes the n x k matrix A, the n right-hand values b, and the penalty `lambda` on |x|_1, at least 0. O(n k).
  row_active_set(Eigen::MatrixXd rows, Eigen::VectorXd right, double lambda, sign_rule signs);

  /// Lets one column enter and moves to the optimum of the passive columns.
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

  /// Returns the optimum of the passive columns; nothing if they depend on each other.
  [[nodiscard]] passive_optimum optimum() const;

  /// Moves to the optimum as in `active_set`. Returns false if the passive columns depend on each other.
  [[nodiscard]] bool settle();

  /// Adds a column to the passive ones. Returns false if it cannot enter because of rounding.
  [[nodiscard]] bool enter(Eigen::Index column);
  [[nodiscard]] bool exchange(Eigen::Index column);

  void drop(std::ptrdiff_t position);
  void choose_entering();

  /// Returns the change of the objective since the state `before` the step.
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
