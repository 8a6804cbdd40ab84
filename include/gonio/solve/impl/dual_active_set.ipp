#pragma once
/// Bodies of solve/dual_active_set.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/solve/compensated.hpp>
#include <gonio/solve/dual_active_set.hpp>
#include <gonio/solve/growing_cholesky.hpp>
#include <gonio/solve/working_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE dual_active_set::dual_active_set(const scaled_program& program, vector rhs,
                                              const active_constraints& start, double shift)
    : dual_active_set(program, std::move(rhs), shift) {
  adopt(start);
  settle();
}

GONIO_INLINE dual_active_set dual_active_set::polished(const dual_active_set& neighbour, vector rhs) {
  dual_active_set result(neighbour.program_, std::move(rhs), 0.0);
  result.adopt(neighbour.active());
  result.set_.update();
  result.singular_ = false;
  result.y_ = neighbour.y_;
  result.row_multiplier_ = neighbour.row_multiplier_;
  result.refine();
  return result;
}

GONIO_INLINE void dual_active_set::step() {
  add(violated_);
  if (!singular_) settle();
}

GONIO_INLINE active_constraints dual_active_set::active() const {
  active_constraints found;
  for (Eigen::Index j = 0; j < program_.unknowns(); ++j) found.bounds.push_back(!set_.is_free(j));
  for (Eigen::Index i = program_.equalities; i < program_.rows(); ++i) found.rows.push_back(set_.has_row(i));
  return found;
}

GONIO_INLINE dual_active_set::dual_active_set(const scaled_program& program, vector rhs, double shift)
    : program_(program),
      rhs_(std::move(rhs)),
      rhs_size_(rhs_.cwiseAbs().maxCoeff()),
      shift_(shift),
      set_(program, shift),
      y_(vector::Zero(program.unknowns())),
      bound_multiplier_(vector::Zero(program.unknowns())),
      row_multiplier_(vector::Zero(program.rows())),
      tolerated_(program.unknowns() + program.rows(), false) {}

GONIO_INLINE void dual_active_set::adopt(const active_constraints& start) {
  for (Eigen::Index j = 0; j < program_.unknowns(); ++j) {
    const bool bound = program_.non_negative && !start.bounds.empty() && start.bounds[j];
    if (!bound && !set_.release(j) && !program_.non_negative) singular_ = true;
  }
  for (Eigen::Index i = 0; i < program_.rows(); ++i)
    if (i < program_.equalities || (!start.rows.empty() && start.rows[i - program_.equalities])) set_.add_row(i);
}

GONIO_INLINE void dual_active_set::settle() {
  for (bool again = true; again && !singular_;) {
    resolve();
    if (drop_wrong_sign()) continue;
    choose_violated();
    // Refine the solution if a violation is small: it may be due to rounding.
    if (violated_ >= 0 && violation(violated_) > small_violation * terms()) return;
    refine();
    update_bound_multipliers();
    again = drop_wrong_sign();
    if (!again) choose_violated();
  }
}

GONIO_INLINE void dual_active_set::resolve() {
  set_.update();
  vector a = set_.gather(rhs_), c(std::ssize(set_.rows()));
  for (Eigen::Index i = 0; i < c.size(); ++i) c[i] = program_.b[set_.rows()[i]];
  set_.solve(a, c);
  y_.setZero();
  row_multiplier_.setZero();
  advance(a, 1.0, c, 1.0);
  if (shift_ > 0.0) refine();  // a shifted singular matrix is ill-conditioned
  update_bound_multipliers();
}

GONIO_INLINE void dual_active_set::advance(const vector& free_part, double free_length, const vector& row_part,
                                           double row_length) {
  for (Eigen::Index i = 0; i < free_part.size(); ++i) y_[set_.free()[i]] += free_length * free_part[i];
  for (Eigen::Index i = 0; i < row_part.size(); ++i) row_multiplier_[set_.rows()[i]] += row_length * row_part[i];
}

GONIO_INLINE void dual_active_set::update_bound_multipliers() {
  bound_multiplier_ = -rhs_;
  for (Eigen::Index j = 0; j < y_.size(); ++j)
    if (y_[j] != 0.0) bound_multiplier_ += y_[j] * program_.G.col(j);
  for (const Eigen::Index i : set_.rows()) bound_multiplier_ -= row_multiplier_[i] * program_.normals.col(i);
  for (const Eigen::Index j : set_.free()) bound_multiplier_[j] = 0.0;
}

GONIO_INLINE double dual_active_set::terms() const { return rhs_size_ + y_.cwiseAbs().maxCoeff(); }

GONIO_INLINE bool dual_active_set::drop_wrong_sign() {
  double worst = -rounding * terms();
  Eigen::Index wrong = -1;
  for (const Eigen::Index i : set_.rows())
    if (i >= program_.equalities && row_multiplier_[i] < worst) {
      worst = row_multiplier_[i];
      wrong = program_.unknowns() + i;
    }
  if (program_.non_negative && bound_multiplier_.minCoeff() < worst) bound_multiplier_.minCoeff(&wrong);
  if (wrong >= 0 && !drop(wrong)) give_up();
  return wrong >= 0;
}

GONIO_INLINE void dual_active_set::choose_violated() {
  const double bounds_tolerance = rounding * terms(), rows_tolerance = 1e-2 * bounds_tolerance;
  const double size = y_.cwiseAbs().maxCoeff();
  double worst = bounds_tolerance;
  violated_ = -1;
  for (Eigen::Index i = 0; i < program_.rows(); ++i) {
    if (violated_ >= 0 && i >= program_.equalities && is_equality(violated_)) return;
    const Eigen::Index constraint = program_.unknowns() + i;
    if (tolerated_[constraint] || set_.has_row(i)) continue;
    const double off = violation(constraint);
    if (off <= 10 * rounding * (std::abs(program_.b[i]) + size) + rows_tolerance) continue;
    if (violated_ >= 0 && off <= worst) continue;
    worst = off;
    violated_ = constraint;
  }
  if (!program_.non_negative || (violated_ >= 0 && is_equality(violated_))) return;
  worst = std::max(worst, bounds_tolerance);
  for (const Eigen::Index j : set_.free()) {
    if (tolerated_[j] || -y_[j] <= worst) continue;
    worst = -y_[j];
    violated_ = j;
  }
}

GONIO_INLINE double dual_active_set::violation(Eigen::Index constraint) const {
  if (!is_row(constraint)) return -y_[constraint];
  const Eigen::Index i = constraint - program_.unknowns();
  const double lacking = program_.b[i] - program_.normals.col(i).dot(y_);
  return i < program_.equalities ? std::abs(lacking) : lacking;
}

GONIO_INLINE void dual_active_set::add(Eigen::Index constraint) {
  const half_space wanted = half_space_of(constraint);
  for (;;) {
    set_.update();
    const direction way = direction_towards(wanted.normal);
    const obstacle first = first_obstacle(way);
    if (way.dependent && first.constraint < 0) return tolerate(constraint, wanted.bound, way);
    if (!way.dependent && !(way.slope > 0.0)) return give_up();
    const double rest = violation(constraint);
    const double full = way.dependent ? std::numeric_limits<double>::infinity() : std::max(rest, 0.0) / way.slope;
    const double length = std::min(full, first.length);
    advance(way.z, length, way.row_rate, -length);
    bound_multiplier_ -= length * way.bound_rate;
    if (full <= first.length) return activate(constraint);
    if (!drop(first.constraint)) return exchange(constraint, first.constraint);
  }
}

GONIO_INLINE dual_active_set::half_space dual_active_set::half_space_of(Eigen::Index constraint) const {
  if (!is_row(constraint)) return {vector::Unit(program_.unknowns(), constraint), 0.0};
  const Eigen::Index i = constraint - program_.unknowns();
  const bool from_above = i < program_.equalities && program_.normals.col(i).dot(y_) > program_.b[i];
  const double sign = from_above ? -1.0 : 1.0;
  return {sign * program_.normals.col(i), sign * program_.b[i]};
}

GONIO_INLINE dual_active_set::direction dual_active_set::direction_towards(const vector& normal) const {
  direction way;
  vector rest = set_.gather(normal);
  way.dependent = set_.depends(rest, way.row_rate);
  way.z = vector::Zero(rest.size());
  if (!way.dependent) {
    // Only the part of the normal that the active rows do not span moves y. Starting from this part keeps its digits.
    way.z = rest;
    vector correction = vector::Zero(way.row_rate.size());
    set_.solve(way.z, correction);
    way.row_rate -= correction;
    way.slope = rest.dot(way.z);
  }
  way.bound_rate = normal;
  for (Eigen::Index i = 0; i < way.row_rate.size(); ++i)
    way.bound_rate -= way.row_rate[i] * program_.normals.col(set_.rows()[i]);
  for (Eigen::Index i = 0; i < way.z.size() && !way.dependent; ++i)
    way.bound_rate -= way.z[i] * program_.G.col(set_.free()[i]);
  for (const Eigen::Index j : set_.free()) way.bound_rate[j] = 0.0;
  return way;
}

GONIO_INLINE dual_active_set::obstacle dual_active_set::first_obstacle(const direction& way) const {
  const double size = 1.0 + way.row_rate.lpNorm<1>() + way.z.lpNorm<1>();
  const double smallest = (way.dependent ? 1e-11 : 1e-15) * size;
  obstacle first;
  const auto consider = [&](Eigen::Index constraint, double multiplier, double rate) {
    // Compare without a division. Most constraints fail this comparison.
    if (rate <= smallest || multiplier >= first.length * rate) return;
    first = {constraint, std::max(multiplier, 0.0) / rate};
  };
  for (Eigen::Index i = 0; i < way.row_rate.size(); ++i) {
    const Eigen::Index row = set_.rows()[i];
    if (row >= program_.equalities) consider(program_.unknowns() + row, row_multiplier_[row], way.row_rate[i]);
  }
  if (!program_.non_negative) return first;
  for (Eigen::Index j = 0; j < y_.size(); ++j)
    consider(j, bound_multiplier_[j], way.bound_rate[j]);  // the rate of a free weight is zero
  return first;
}

GONIO_INLINE void dual_active_set::activate(Eigen::Index constraint) {
  ++changes_;
  if (is_row(constraint))
    set_.add_row(constraint - program_.unknowns());
  else
    set_.fix(constraint);
}

GONIO_INLINE bool dual_active_set::drop(Eigen::Index constraint) {
  ++changes_;
  if (!is_row(constraint)) return set_.release(constraint);
  set_.drop_row(constraint - program_.unknowns());
  row_multiplier_[constraint - program_.unknowns()] = 0.0;
  return true;
}

GONIO_INLINE void dual_active_set::exchange(Eigen::Index added, Eigen::Index dropped) {
  if (is_row(added) || !set_.rows().empty()) return give_up();
  activate(added);
  if (!set_.release(dropped)) give_up();
}

GONIO_INLINE void dual_active_set::tolerate(Eigen::Index constraint, double bound, const direction& way) {
  double allowed = 0.0, size = std::abs(bound);
  for (Eigen::Index i = 0; i < way.row_rate.size(); ++i) {
    const double part = way.row_rate[i] * program_.b[set_.rows()[i]];
    allowed += part;
    size += std::abs(part);
  }
  if (bound - allowed > 1e3 * rounding * size)
    refuse({"the constraints contradict one another: no weights satisfy ", describe(constraint),
            " together with all other constraints"});
  tolerated_[constraint] = true;
}

GONIO_INLINE std::string dual_active_set::describe(Eigen::Index constraint) const {
  if (!is_row(constraint)) return "the bound of weight " + std::to_string(constraint);
  const Eigen::Index i = constraint - program_.unknowns();
  return i < program_.equalities ? "equality row " + std::to_string(i)
                                 : "inequality row " + std::to_string(i - program_.equalities);
}

GONIO_INLINE void dual_active_set::refine() {
  double last = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < 20; ++pass) {
    vector a(std::ssize(set_.free())), c(std::ssize(set_.rows()));
    for (Eigen::Index i = 0; i < a.size(); ++i) a[i] = gradient_misfit(set_.free()[i]);
    for (Eigen::Index i = 0; i < c.size(); ++i) c[i] = row_misfit(set_.rows()[i]);
    set_.solve(a, c);
    const double change = a.size() > 0 ? a.cwiseAbs().maxCoeff() : 0.0;
    if (!(change < 0.7 * last)) return;
    advance(a, 1.0, c, 1.0);
    if (change <= 1e-15 * y_.cwiseAbs().maxCoeff()) return;
    last = change;
  }
}

GONIO_INLINE double dual_active_set::gradient_misfit(Eigen::Index j) const {
  compensated_sum misfit(rhs_[j]);
  for (Eigen::Index i = 0; i < y_.size(); ++i)
    if (y_[i] != 0.0) misfit.add_product(-program_.G(i, j), y_[i]);
  misfit.add_product(-shift_, y_[j]);
  for (Eigen::Index i = 0; i < program_.rows(); ++i)
    if (row_multiplier_[i] != 0.0) misfit.add_product(program_.normals(j, i), row_multiplier_[i]);
  return misfit.value();
}

GONIO_INLINE double dual_active_set::row_misfit(Eigen::Index i) const {
  compensated_sum misfit(program_.b[i]);
  for (Eigen::Index j = 0; j < y_.size(); ++j) misfit.add_product(-program_.normals(j, i), y_[j]);
  return misfit.value();
}

}  // namespace gonio
