#pragma once
/// The linear systems of active-set methods for quadratic programs: a set of constraints that hold with equality, and
/// its Karush-Kuhn-Tucker system. Nocedal and Wright, Numerical Optimization, 2nd ed., section 16.2.

#include <gonio/solve/growing_cholesky.hpp>
#include <gonio/solve/scaled_program.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <utility>
#include <vector>

namespace gonio {

/// Solves (G_FF + shift I) z - N r = a,  N'z = c over the free weights F, with the normals of the active rows (their
/// entries of F) as columns of N. Uses the Cholesky factor of G_FF + shift I and an orthonormal basis of N, so that G
/// does not affect which rows count as dependent. The comments on members call the number of free weights p, and the
/// number of active rows w.
class working_set {
 public:
  using vector = Eigen::VectorXd;

  /// Starts with all weights at zero and no active row. Keeps a reference to `program`.
  working_set(const scaled_program& program, double shift);

  /// Returns the free weights, in the order of z.
  [[nodiscard]] const std::vector<Eigen::Index>& free() const noexcept { return free_; }
  /// Returns the active rows in the order of r.
  [[nodiscard]] const std::vector<Eigen::Index>& rows() const noexcept { return rows_; }
  [[nodiscard]] bool is_free(Eigen::Index j) const { return is_free_[j]; }
  [[nodiscard]] bool has_row(Eigen::Index i) const { return std::ranges::find(rows_, i) != rows_.end(); }

  /// Frees a weight. Returns false and changes nothing if its column depends on the columns of the free weights. O(p^2)
  /// for p free weights.
  bool release(Eigen::Index j);
  /// O(p^2).
  void fix(Eigen::Index j);
  void add_row(Eigen::Index i);
  void drop_row(Eigen::Index i);

  /// Prepares solving; call it after changes. Leaves out rows that depend on earlier rows. O(w p^2 + w^2 p) for p free
  /// weights and w active rows.
  void update();

  /// Returns the entries of `all` that belong to free weights.
  [[nodiscard]] vector gather(const Eigen::Ref<const vector>& all) const;

  /// Subtracts from `normal` (over the p free weights) the part that the w active rows span, and writes this part's
  /// coefficients to `combination`. Returns true if only rounding is left. O(w p).
  [[nodiscard]] bool depends(vector& normal, vector& combination) const;

  /// Solves the system: replaces a by z and c by r. O(p^2 + w p + w^2) for p free weights and w active rows.
  void solve(vector& a, vector& c) const;

 private:
  [[nodiscard]] bool append_to_basis(Eigen::Index row, Eigen::Index at);

  /// Subtracts from `rest` the part that the first `count` vectors of the basis span. Does so twice, because a single
  /// pass loses digits. Returns false if only rounding is left.
  [[nodiscard]] bool orthogonalise(vector& rest, vector& coefficients, Eigen::Index count) const;

  /// Back substitution.
  void solve_triangle(vector& c) const;

  const scaled_program& program_;
  double shift_;
  growing_cholesky factor_;    // of G_FF + shift I
  growing_cholesky schur_{0};  // of basis' (G_FF + shift I)^-1 basis
  std::vector<bool> is_free_;
  std::vector<Eigen::Index> free_, rows_;
  Eigen::MatrixXd basis_, triangle_;  // N = basis * triangle
  Eigen::MatrixXd solved_;            // (G_FF + shift I)^-1 basis
  bool changed_ = true;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/working_set.ipp>
#endif
