#pragma once
/// The linear systems of active-set methods for quadratic programs: a set of constraints that hold with equality, and
/// the Karush-Kuhn-Tucker system over it. Nocedal and Wright, Numerical Optimization, 2nd ed., section 16.2.

#include <gonio/solve/scaled_program.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <utility>
#include <vector>

namespace gonio {

/// Solves
///   (G_FF + shift I) z - N r = a,  N'z = c
/// over the free weights F, with the normals of the active rows (their entries of F) as columns of N: by the Cholesky
/// factor of G_FF + shift I and an orthonormal basis of N, so that G has no say in which rows depend on one another.
/// `Factor` is as `growing_cholesky`. Below, p is the number of free weights and w that of active rows.
template <class Factor>
class working_set {
 public:
  using vector = Eigen::VectorXd;

  /// All weights are at zero and no row is active. Keeps a reference to `program`.
  working_set(const scaled_program<double>& program, double shift)
      : program_(program),
        shift_(shift),
        factor_(program.unknowns()),
        is_free_(static_cast<std::size_t>(program.unknowns()), false) {}

  /// In the order of z.
  [[nodiscard]] const std::vector<Eigen::Index>& free() const noexcept { return free_; }
  /// In the order of r.
  [[nodiscard]] const std::vector<Eigen::Index>& rows() const noexcept { return rows_; }
  [[nodiscard]] bool is_free(Eigen::Index j) const { return is_free_[static_cast<std::size_t>(j)]; }
  [[nodiscard]] bool has_row(Eigen::Index i) const { return std::ranges::find(rows_, i) != rows_.end(); }

  /// Returns false and leaves the weight where it is if its column depends on the free ones. O(p^2).
  bool release(Eigen::Index j) {
    vector cross = gather(program_.G.col(j));
    if (!factor_.append(cross, program_.G(j, j) + shift_)) return false;
    free_.push_back(j);
    changed_ = is_free_[static_cast<std::size_t>(j)] = true;
    return true;
  }
  /// O(p^2).
  void fix(Eigen::Index j) {
    const auto place = std::ranges::find(free_, j);
    factor_.remove(place - free_.begin());
    free_.erase(place);
    is_free_[static_cast<std::size_t>(j)] = false;
    changed_ = true;
  }
  void add_row(Eigen::Index i) {
    rows_.push_back(i);
    changed_ = true;
  }
  void drop_row(Eigen::Index i) {
    std::erase(rows_, i);
    changed_ = true;
  }

  /// To be called between changes and what follows. Leaves out rows that depend on earlier ones. O(w p^2 + w^2 p).
  void update() {
    if (!std::exchange(changed_, false)) return;
    const auto p = std::ssize(free_), w = std::ssize(rows_);
    basis_.resize(p, w);
    solved_.resize(p, w);
    triangle_.resize(w, w);
    schur_ = Factor(w);
    std::vector<Eigen::Index> independent;
    for (const Eigen::Index i : rows_)
      if (append_to_basis(i, std::ssize(independent))) independent.push_back(i);
    rows_ = std::move(independent);
  }

  /// The free weights' entries.
  template <class Vector>
  [[nodiscard]] vector gather(const Eigen::MatrixBase<Vector>& all) const {
    vector some(std::ssize(free_));
    for (Eigen::Index i = 0; i < some.size(); ++i) some[i] = all[free_[static_cast<std::size_t>(i)]];
    return some;
  }

  /// Takes out of `normal` (over the free weights) its `combination` of the active rows. Returns whether nothing but
  /// rounding is left. O(w p).
  [[nodiscard]] bool depends(vector& normal, vector& combination) const {
    const bool independent = orthogonalise(normal, combination, std::ssize(rows_));
    solve_triangle(combination);
    return !independent;
  }

  /// z takes the place of a and r that of c. O(p^2 + w p + w^2).
  void solve(vector& a, vector& c) const {
    const auto w = std::ssize(rows_);
    factor_.solve(a);
    if (w == 0) return;
    for (Eigen::Index i = 0; i < w; ++i) c[i] = (c[i] - triangle_.col(i).head(i).dot(c.head(i))) / triangle_(i, i);
    c -= basis_.leftCols(w).transpose() * a;
    schur_.solve(c);
    a += solved_.leftCols(w) * c;
    solve_triangle(c);
  }

 private:
  [[nodiscard]] bool append_to_basis(Eigen::Index row, Eigen::Index at) {
    vector rest = gather(program_.normals.col(row)), coefficients;
    if (!orthogonalise(rest, coefficients, at)) return false;
    const double length = rest.norm();
    basis_.col(at) = rest / length;
    vector solved = basis_.col(at);
    factor_.solve(solved);
    vector cross = basis_.leftCols(at).transpose() * solved;
    if (!schur_.append(cross, basis_.col(at).dot(solved))) return false;
    solved_.col(at) = solved;
    triangle_.col(at).head(at) = coefficients;
    triangle_(at, at) = length;
    return true;
  }

  /// Takes out of `rest` what the first `count` vectors of the basis span, twice because once loses digits. Returns
  /// false if only rounding is left.
  [[nodiscard]] bool orthogonalise(vector& rest, vector& coefficients, Eigen::Index count) const {
    constexpr double rounding = 1e-11;
    const double before = rest.norm();
    coefficients.setZero(count);
    for (int pass = 0; pass < 2; ++pass)
      for (Eigen::Index i = 0; i < count; ++i) {
        const double part = basis_.col(i).dot(rest);
        coefficients[i] += part;
        rest -= part * basis_.col(i);
      }
    return count < rest.size() && rest.norm() > rounding * before;
  }

  /// Back substitution.
  void solve_triangle(vector& c) const {
    for (Eigen::Index i = c.size() - 1; i >= 0; --i) {
      c[i] /= triangle_(i, i);
      c.head(i) -= c[i] * triangle_.col(i).head(i);
    }
  }

  const scaled_program<double>& program_;
  double shift_;
  Factor factor_;    // of G_FF + shift I
  Factor schur_{0};  // of basis' (G_FF + shift I)^-1 basis
  std::vector<bool> is_free_;
  std::vector<Eigen::Index> free_, rows_;
  Eigen::MatrixXd basis_, triangle_;  // N = basis * triangle
  Eigen::MatrixXd solved_;            // (G_FF + shift I)^-1 basis
  bool changed_ = true;
};

}  // namespace gonio
