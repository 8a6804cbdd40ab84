#pragma once
/// Bodies of solve/working_set.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/growing_cholesky.hpp>
#include <gonio/solve/scaled_program.hpp>
#include <gonio/solve/thin_product.hpp>
#include <gonio/solve/working_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE working_set::working_set(const scaled_program& program, double shift)
    : program_(program), shift_(shift), factor_(program.unknowns()), is_free_(program.unknowns(), false) {}

GONIO_INLINE bool working_set::release(Eigen::Index j) {
  vector cross = gather(program_.G.col(j));
  if (!factor_.append(cross, program_.G(j, j) + shift_)) return false;
  free_.push_back(j);
  changed_ = is_free_[j] = true;
  return true;
}

GONIO_INLINE void working_set::fix(Eigen::Index j) {
  const auto fixed = std::ranges::find(free_, j);
  factor_.remove(fixed - free_.begin());
  free_.erase(fixed);
  is_free_[j] = false;
  changed_ = true;
}

GONIO_INLINE void working_set::add_row(Eigen::Index i) {
  rows_.push_back(i);
  changed_ = true;
}

GONIO_INLINE void working_set::drop_row(Eigen::Index i) {
  std::erase(rows_, i);
  changed_ = true;
}

GONIO_INLINE void working_set::update() {
  if (!std::exchange(changed_, false)) return;
  const auto p = std::ssize(free_), w = std::ssize(rows_);
  basis_.resize(p, w);
  solved_.resize(p, w);
  triangle_.resize(w, w);
  schur_ = growing_cholesky(w);
  std::vector<Eigen::Index> independent;
  for (const Eigen::Index i : rows_)
    if (append_to_basis(i, std::ssize(independent))) independent.push_back(i);
  rows_ = std::move(independent);
}

GONIO_INLINE working_set::vector working_set::gather(const Eigen::Ref<const vector>& all) const {
  vector some(std::ssize(free_));
  for (Eigen::Index i = 0; i < some.size(); ++i) some[i] = all[free_[i]];
  return some;
}

GONIO_INLINE bool working_set::depends(vector& normal, vector& combination) const {
  const bool independent = orthogonalise(normal, combination, std::ssize(rows_));
  solve_triangle(combination);
  return !independent;
}

GONIO_INLINE void working_set::solve(vector& a, vector& c) const {
  const auto w = std::ssize(rows_);
  factor_.solve(a);
  if (w == 0) return;
  for (Eigen::Index i = 0; i < w; ++i) c[i] = (c[i] - triangle_.col(i).head(i).dot(c.head(i))) / triangle_(i, i);
  c -= thin_transposed_product(basis_.leftCols(w), a);
  schur_.solve(c);
  a += thin_product(solved_.leftCols(w), c);
  solve_triangle(c);
}

GONIO_INLINE bool working_set::append_to_basis(Eigen::Index row, Eigen::Index at) {
  vector rest = gather(program_.normals.col(row)), coefficients;
  if (!orthogonalise(rest, coefficients, at)) return false;
  const double length = rest.norm();
  basis_.col(at) = rest / length;
  vector solved = basis_.col(at);
  factor_.solve(solved);
  vector cross = thin_transposed_product(basis_.leftCols(at), solved);
  if (!schur_.append(cross, basis_.col(at).dot(solved))) return false;
  solved_.col(at) = solved;
  triangle_.col(at).head(at) = coefficients;
  triangle_(at, at) = length;
  return true;
}

GONIO_INLINE bool working_set::orthogonalise(vector& rest, vector& coefficients, Eigen::Index count) const {
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

GONIO_INLINE void working_set::solve_triangle(vector& c) const {
  for (Eigen::Index i = c.size() - 1; i >= 0; --i) {
    c[i] /= triangle_(i, i);
    c.head(i) -= c[i] * triangle_.col(i).head(i);
  }
}

}  // namespace gonio
