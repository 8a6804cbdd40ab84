#pragma once
/// The dual active-set method for strictly convex quadratic programs: Goldfarb and Idnani, Mathematical Programming 27,
/// 1983. Active bounds are no rows of the systems: their weights leave them.

#include <gonio/solve/compensated.hpp>
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

/// Minimises 1/2 y'(G + shift I) y - q'y under the constraints of a program. Each point is optimal for some of the
/// constraints, those of its working set; a step adds the constraint that it violates most and drops those in the way,
/// and the objective rises.
///
/// Adding or dropping one constraint costs O(k p + p^2 + w p^2 + w^2 p) for k weights, p of them free, and w active
/// rows.
template <class Factor = growing_cholesky<double>>
class dual_active_set {
 public:
  using vector = Eigen::VectorXd;

  /// Starts with the constraints of `start` as equations, without those whose multipliers have the wrong sign: without
  /// inequalities if there are none, as Goldfarb and Idnani do. Keeps a reference to `program`; `moment` is q.
  dual_active_set(const scaled_program<double>& program, vector moment, const active_constraints& start = {},
                  double shift = 0.0)
      : dual_active_set(program, std::move(moment), shift) {
    adopt(start);
    settle();
  }

  /// The neighbour, whose G had a shift, without it: solves for the free weights whose columns are independent of one
  /// another, keeps the others as they are and does not change what is active.
  [[nodiscard]] static dual_active_set polished(const dual_active_set& neighbour, vector moment) {
    dual_active_set result(neighbour.program_, std::move(moment), 0.0);
    result.adopt(neighbour.active());
    result.set_.update();
    result.singular_ = false;
    result.y_ = neighbour.y_;
    result.row_multiplier_ = neighbour.row_multiplier_;
    result.refine();
    return result;
  }

  /// Adds one constraint. Throws gonio::error if the constraints contradict one another.
  void step() {
    add(violated_);
    if (!singular_) settle();
  }

  [[nodiscard]] bool converged() const noexcept { return singular_ || violated_ < 0; }
  /// Is this the end because the columns of the free weights depend on one another?
  [[nodiscard]] bool singular() const noexcept { return singular_; }

  /// How often a constraint has been added or dropped, the start's corrections included.
  [[nodiscard]] int changes() const noexcept { return changes_; }

  /// x = S^-1 y.
  [[nodiscard]] vector weights() const { return program_.weights(y_); }
  [[nodiscard]] const vector& scaled_weights() const noexcept { return y_; }
  [[nodiscard]] constraint_multipliers multipliers() const { return program_.multipliers(row_multiplier_); }

  [[nodiscard]] active_constraints active() const {
    active_constraints found;
    for (Eigen::Index j = 0; j < program_.unknowns(); ++j) found.bounds.push_back(!set_.is_free(j));
    for (Eigen::Index i = program_.equalities; i < program_.rows(); ++i) found.rows.push_back(set_.has_row(i));
    return found;
  }

 private:
  // Relative to `terms` a violation or a multiplier of this size is rounding.
  static constexpr double rounding = 1e-13;

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

  dual_active_set(const scaled_program<double>& program, vector moment, double shift)
      : program_(program),
        moment_(std::move(moment)),
        moment_size_(moment_.cwiseAbs().maxCoeff()),
        shift_(shift),
        set_(program, shift),
        y_(vector::Zero(program.unknowns())),
        bound_multiplier_(vector::Zero(program.unknowns())),
        row_multiplier_(vector::Zero(program.rows())),
        tolerated_(static_cast<std::size_t>(program.unknowns() + program.rows()), false) {}

  [[nodiscard]] bool is_row(Eigen::Index constraint) const { return constraint >= program_.unknowns(); }
  [[nodiscard]] bool is_equality(Eigen::Index constraint) const {
    return is_row(constraint) && constraint - program_.unknowns() < program_.equalities;
  }

  void adopt(const active_constraints& start) {
    for (Eigen::Index j = 0; j < program_.unknowns(); ++j) {
      const bool bound = program_.non_negative && !start.bounds.empty() && start.bounds[static_cast<std::size_t>(j)];
      if (!bound && !set_.release(j) && !program_.non_negative) singular_ = true;
    }
    for (Eigen::Index i = 0; i < program_.rows(); ++i)
      if (i < program_.equalities ||
          (!start.rows.empty() && start.rows[static_cast<std::size_t>(i - program_.equalities)]))
        set_.add_row(i);
  }

  /// Moves to the optimum of the working set, and drops constraints until their multipliers have the right sign.
  void settle() {
    for (bool again = true; again && !singular_;) {
      resolve();
      if (drop_wrong_sign()) continue;
      choose_violated();
      if (violated_ >= 0) return;
      refine();
      update_bound_multipliers();
      again = drop_wrong_sign();
      if (!again) choose_violated();
    }
  }

  void resolve() {
    set_.update();
    vector a = set_.gather(moment_), c(std::ssize(set_.rows()));
    for (Eigen::Index i = 0; i < c.size(); ++i) c[i] = program_.b[set_.rows()[static_cast<std::size_t>(i)]];
    set_.solve(a, c);
    y_.setZero();
    row_multiplier_.setZero();
    advance(a, 1.0, c, 1.0);
    if (shift_ > 0.0) refine();  // what is left of a singular matrix is ill-conditioned
    update_bound_multipliers();
  }

  void advance(const vector& free_part, double free_length, const vector& row_part, double row_length) {
    for (Eigen::Index i = 0; i < free_part.size(); ++i)
      y_[set_.free()[static_cast<std::size_t>(i)]] += free_length * free_part[i];
    for (Eigen::Index i = 0; i < row_part.size(); ++i)
      row_multiplier_[set_.rows()[static_cast<std::size_t>(i)]] += row_length * row_part[i];
  }

  /// The gradient of the Lagrangian: zero for free weights.
  void update_bound_multipliers() {
    bound_multiplier_ = -moment_;
    for (Eigen::Index j = 0; j < y_.size(); ++j)
      if (y_[j] != 0.0) bound_multiplier_ += y_[j] * program_.G.col(j);
    for (const Eigen::Index i : set_.rows()) bound_multiplier_ -= row_multiplier_[i] * program_.normals.col(i);
    for (const Eigen::Index j : set_.free()) bound_multiplier_[j] = 0.0;
  }

  /// The size of what cancels in the gradient.
  [[nodiscard]] double terms() const { return moment_size_ + y_.cwiseAbs().maxCoeff(); }

  /// Drops the constraint whose multiplier has the wrong sign the most. Returns whether there was one. If it cannot be
  /// dropped because its column depends on the free ones, the method ends.
  [[nodiscard]] bool drop_wrong_sign() {
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

  /// Equations come first.
  void choose_violated() {
    const double bounds_tolerance = rounding * terms(), rows_tolerance = 1e-2 * bounds_tolerance;
    const double size = y_.cwiseAbs().maxCoeff();
    double worst = bounds_tolerance;
    violated_ = -1;
    for (Eigen::Index i = 0; i < program_.rows(); ++i) {
      if (violated_ >= 0 && i >= program_.equalities && is_equality(violated_)) return;
      const Eigen::Index constraint = program_.unknowns() + i;
      if (tolerated_[static_cast<std::size_t>(constraint)] || set_.has_row(i)) continue;
      const double off = violation(constraint);
      if (off <= 10 * rounding * (std::abs(program_.b[i]) + size) + rows_tolerance) continue;
      if (violated_ >= 0 && off <= worst) continue;
      worst = off;
      violated_ = constraint;
    }
    if (!program_.non_negative || (violated_ >= 0 && is_equality(violated_))) return;
    worst = std::max(worst, bounds_tolerance);
    for (const Eigen::Index j : set_.free()) {
      if (tolerated_[static_cast<std::size_t>(j)] || -y_[j] <= worst) continue;
      worst = -y_[j];
      violated_ = j;
    }
  }

  [[nodiscard]] double violation(Eigen::Index constraint) const {
    if (!is_row(constraint)) return -y_[constraint];
    const Eigen::Index i = constraint - program_.unknowns();
    const double lacking = program_.b[i] - program_.normals.col(i).dot(y_);
    return i < program_.equalities ? std::abs(lacking) : lacking;
  }

  /// Goldfarb and Idnani's step 2: moves towards the constraint, as far as the multipliers of the others allow, drops
  /// the one that stops it, and goes on until it holds.
  void add(Eigen::Index constraint) {
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

  /// The side of an equation on which y is not.
  [[nodiscard]] half_space half_space_of(Eigen::Index constraint) const {
    if (!is_row(constraint)) return {vector::Unit(program_.unknowns(), constraint), 0.0};
    const Eigen::Index i = constraint - program_.unknowns();
    const bool from_above = i < program_.equalities && program_.normals.col(i).dot(y_) > program_.b[i];
    const double sign = from_above ? -1.0 : 1.0;
    return {sign * program_.normals.col(i), sign * program_.b[i]};
  }

  [[nodiscard]] direction direction_towards(const vector& normal) const {
    direction way;
    vector rest = set_.gather(normal);
    way.dependent = set_.depends(rest, way.row_rate);
    way.z = vector::Zero(rest.size());
    if (!way.dependent) {
      // What the active rows do not span is all that moves y: starting from it keeps its digits.
      way.z = rest;
      vector correction = vector::Zero(way.row_rate.size());
      set_.solve(way.z, correction);
      way.row_rate -= correction;
      way.slope = rest.dot(way.z);
    }
    way.bound_rate = normal;
    for (Eigen::Index i = 0; i < way.row_rate.size(); ++i)
      way.bound_rate -= way.row_rate[i] * program_.normals.col(set_.rows()[static_cast<std::size_t>(i)]);
    for (Eigen::Index i = 0; i < way.z.size() && !way.dependent; ++i)
      way.bound_rate -= way.z[i] * program_.G.col(set_.free()[static_cast<std::size_t>(i)]);
    for (const Eigen::Index j : set_.free()) way.bound_rate[j] = 0.0;
    return way;
  }

  /// The active inequality whose multiplier is the first to reach zero.
  [[nodiscard]] obstacle first_obstacle(const direction& way) const {
    const double size = 1.0 + way.row_rate.template lpNorm<1>() + way.z.template lpNorm<1>();
    const double smallest = (way.dependent ? 1e-11 : 1e-15) * size;
    obstacle first;
    const auto consider = [&](Eigen::Index constraint, double multiplier, double rate) {
      // Most are ruled out by a product.
      if (rate <= smallest || multiplier >= first.length * rate) return;
      first = {constraint, std::max(multiplier, 0.0) / rate};
    };
    for (Eigen::Index i = 0; i < way.row_rate.size(); ++i) {
      const Eigen::Index row = set_.rows()[static_cast<std::size_t>(i)];
      if (row >= program_.equalities) consider(program_.unknowns() + row, row_multiplier_[row], way.row_rate[i]);
    }
    if (!program_.non_negative) return first;
    for (Eigen::Index j = 0; j < y_.size(); ++j)
      consider(j, bound_multiplier_[j], way.bound_rate[j]);  // the rate of a free weight is zero
    return first;
  }

  void activate(Eigen::Index constraint) {
    ++changes_;
    if (is_row(constraint))
      set_.add_row(constraint - program_.unknowns());
    else
      set_.fix(constraint);
  }

  [[nodiscard]] bool drop(Eigen::Index constraint) {
    ++changes_;
    if (!is_row(constraint)) return set_.release(constraint);
    set_.drop_row(constraint - program_.unknowns());
    row_multiplier_[constraint - program_.unknowns()] = 0.0;
    return true;
  }

  /// The bound `dropped` would make the free columns dependent: y moves along the direction that G does not see, which
  /// changes no multiplier, until the bound `added` holds and takes its place. With rows it might not see it either.
  void exchange(Eigen::Index added, Eigen::Index dropped) {
    if (is_row(added) || !set_.rows().empty()) return give_up();
    activate(added);
    if (!set_.release(dropped)) give_up();
  }

  /// The active constraints forbid this one: its normal is a combination of theirs, in which none that could give way
  /// helps. If the right-hand sides contradict that beyond rounding it proves that there is no solution (Farkas).
  void tolerate(Eigen::Index constraint, double bound, const direction& way) {
    double allowed = 0.0, size = std::abs(bound);
    for (Eigen::Index i = 0; i < way.row_rate.size(); ++i) {
      const double part = way.row_rate[i] * program_.b[set_.rows()[static_cast<std::size_t>(i)]];
      allowed += part;
      size += std::abs(part);
    }
    if (bound - allowed > 1e3 * rounding * size)
      throw error("the constraints contradict one another: no weights satisfy " + describe(constraint) +
                  " together with the others");
    tolerated_[static_cast<std::size_t>(constraint)] = true;
  }

  [[nodiscard]] std::string describe(Eigen::Index constraint) const {
    if (!is_row(constraint)) return "the bound of weight " + std::to_string(constraint);
    const Eigen::Index i = constraint - program_.unknowns();
    return i < program_.equalities ? "equality row " + std::to_string(i)
                                   : "inequality row " + std::to_string(i - program_.equalities);
  }

  void give_up() noexcept { singular_ = true; }

  /// Iterative refinement with residuals in twice the precision, as long as it helps.
  void refine() {
    double last = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < 20; ++pass) {
      vector a(std::ssize(set_.free())), c(std::ssize(set_.rows()));
      for (Eigen::Index i = 0; i < a.size(); ++i) a[i] = gradient_misfit(set_.free()[static_cast<std::size_t>(i)]);
      for (Eigen::Index i = 0; i < c.size(); ++i) c[i] = row_misfit(set_.rows()[static_cast<std::size_t>(i)]);
      set_.solve(a, c);
      const double change = a.size() > 0 ? a.cwiseAbs().maxCoeff() : 0.0;
      if (!(change < 0.7 * last)) return;
      advance(a, 1.0, c, 1.0);
      if (change <= 1e-15 * y_.cwiseAbs().maxCoeff()) return;
      last = change;
    }
  }

  [[nodiscard]] double gradient_misfit(Eigen::Index j) const {
    compensated_sum misfit(moment_[j]);
    for (Eigen::Index i = 0; i < y_.size(); ++i)
      if (y_[i] != 0.0) misfit.add_product(-program_.G(i, j), y_[i]);
    misfit.add_product(-shift_, y_[j]);
    for (Eigen::Index i = 0; i < program_.rows(); ++i)
      if (row_multiplier_[i] != 0.0) misfit.add_product(program_.normals(j, i), row_multiplier_[i]);
    return misfit.value();
  }
  [[nodiscard]] double row_misfit(Eigen::Index i) const {
    compensated_sum misfit(program_.b[i]);
    for (Eigen::Index j = 0; j < y_.size(); ++j) misfit.add_product(-program_.normals(j, i), y_[j]);
    return misfit.value();
  }

  const scaled_program<double>& program_;
  vector moment_;
  double moment_size_;  // the largest of it
  double shift_;
  working_set<Factor> set_;
  vector y_, bound_multiplier_, row_multiplier_;
  std::vector<bool> tolerated_;  // violated by rounding alone, though nothing can be done about it
  Eigen::Index violated_ = -1;
  int changes_ = 0;
  bool singular_ = false;
};

}  // namespace gonio
