#pragma once
/// Searches for the best measurements, for any geometry of candidates and any objective. Random swaps: Matusik,
/// Pfister, Brand and McMillan 2003. Descent on the grid: after Nielsen, Jensen and Ramamoorthi 2015
/// (doi:10.1145/2816795.2818085), section 4. The paper's steps follow the numerical gradient, which is no better
/// (examples/papers/nielsen2015/gradient_descent.hpp, docs/results/figures.md). Descent from the best of many
/// candidates: Xu et al. 2016 (doi:10.1145/2980179.2982396), section 5.1.

#include <gonio/core/error.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/design/capture_geometry.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace gonio::design {

/// Returns the value of a set of candidates; smaller is better. The value must not depend on the order of the
/// candidates.
///
/// An objective may offer `beside(candidates)`, which returns a function of one more candidate. The function returns
/// the value of the set with this candidate, at a lower cost than for a new set. Searches that move one candidate at a
/// time then use it.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/design/criterion_of_plan.hpp>
/// #include <gonio/design/search.hpp>
/// #include <gonio/io/materials/prior.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const auto prior = gonio::io::read_prior("materials.prior");
///   const gonio::design::point_geometry points(prior.cells());
///   const gonio::design::criterion_of_plan volume{prior, points, gonio::design::d_optimality{}};
///   std::printf("%g\n", gonio::design::swap_at_random(points, volume, 5, 1000).value);
/// }
/// ```
/// With a model of your own, candidates as far apart as possible:
/// ```cpp
/// #include <gonio/design/search.hpp>
///
/// #include <cstdio>
///
/// struct crowding {
///   gonio::design::point_geometry points;
///   double operator()(std::span<const Eigen::Index> candidates) const {
///     double sum = 0.0;
///     for (const Eigen::Index a : candidates)
///       for (const Eigen::Index b : candidates)
///         if (a < b) sum += 1.0 / (0.01 + gonio::angle_between(points.centre(a).wi, points.centre(b).wi));
///     return sum;
///   }
/// };
/// static_assert(gonio::design::plan_objective<crowding>);
///
/// int main() {
///   const gonio::design::point_geometry points{gonio::valid_cells(gonio::grid({10, 8, 12}))};
///   std::printf("%g\n", gonio::design::grow_and_descend(points, crowding{points}, 5).value);
/// }
/// ```
template <class Objective>
concept plan_objective = requires(const Objective& objective, std::span<const Eigen::Index> candidates) {
  { objective(candidates) } -> std::convertible_to<double>;
};

/// Distinct candidates to measure, and the value of the set.
struct capture_plan {
  std::vector<Eigen::Index> candidates;
  double value = std::numeric_limits<double>::infinity();
};

namespace detail {

/// Refuses unless n is from 1 to the number of allowed candidates.
template <capture_geometry Geometry>
void require_choice(Eigen::Index n, const Geometry& geometry) {
  Eigen::Index allowed = 0;
  for (Eigen::Index candidate = 0; candidate < geometry.size(); ++candidate)
    if (geometry.allows(candidate)) ++allowed;
  if constexpr (requires { geometry.excluding_rule(); }) {
    if (allowed == 0)
      refuse("the rule '" + geometry.excluding_rule() +
             "' of the apparatus leaves no direction to measure: relax this rule");
  }
  if (n < 1 || n > allowed)
    refuse("cannot choose " + std::to_string(n) + " of " + std::to_string(allowed) + " candidates");
}

[[nodiscard]] inline bool holds(const std::vector<Eigen::Index>& candidates, Eigen::Index candidate) {
  return std::ranges::find(candidates, candidate) != candidates.end();
}

/// Returns a random allowed candidate that is not in the plan.
template <capture_geometry Geometry, class Generator>
[[nodiscard]] Eigen::Index another_candidate(const std::vector<Eigen::Index>& plan, const Geometry& geometry,
                                             Generator& generator) {
  std::uniform_int_distribution<Eigen::Index> any(0, geometry.size() - 1);
  Eigen::Index candidate = any(generator);
  while (!geometry.allows(candidate) || holds(plan, candidate)) candidate = any(generator);
  return candidate;
}

[[nodiscard]] std::vector<Eigen::Index> without(std::vector<Eigen::Index> candidates, Eigen::Index position);

/// Returns the value of a plan as a function of the candidate at one position; infinity if another position has that
/// candidate.
template <plan_objective Objective>
[[nodiscard]] auto value_of_replacement(const Objective& objective, const std::vector<Eigen::Index>& candidates,
                                        Eigen::Index position) {
  const std::vector<Eigen::Index> others = without(candidates, position);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if constexpr (requires { objective.beside(std::span<const Eigen::Index>(others)); }) {
    return [=, with = objective.beside(std::span<const Eigen::Index>(others))](Eigen::Index candidate) -> double {
      return holds(others, candidate) ? infinity : with(candidate);
    };
  } else {
    return [=, &objective](Eigen::Index candidate) -> double {
      if (holds(others, candidate)) return infinity;
      std::vector<Eigen::Index> all = others;
      all.push_back(candidate);
      return objective(std::span<const Eigen::Index>(all));
    };
  }
}

/// Returns true if `value` is below `on` by more than rounding. Values may be negative: some criteria are logarithms.
[[nodiscard]] inline bool improves(double value, double on, double rounding = 1e-12) noexcept {
  return value < on && (std::isinf(on) || on - value > rounding * std::abs(on));
}

/// Moves one candidate to the best of its six neighbours at some distance, if that improves the plan. Returns true if
/// it moved.
template <capture_geometry Geometry, plan_objective Objective>
[[nodiscard]] bool move_one(const Geometry& geometry, const Objective& objective, capture_plan& plan,
                            Eigen::Index position, int distance) {
  const auto value_with = value_of_replacement(objective, plan.candidates, position);
  const Eigen::Index from = plan.candidates[position];
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const int sign : {1, -1}) {
      grid_step step{};
      step[axis] = sign * distance;
      const std::optional<Eigen::Index> to = geometry.stepped(from, step);
      if (!to) continue;
      const double value = value_with(*to);
      if (!improves(value, plan.value)) continue;
      plan.value = value;
      plan.candidates[position] = *to;
    }
  return plan.candidates[position] != from;
}

}  // namespace detail

/// Moves candidates of a plan along the grid while that improves the plan: first in steps of 3, then in steps of 1,
/// each in the best of six directions. The candidates take turns in random order. In the end, no single step of a
/// candidate improves the plan.
template <capture_geometry Geometry, plan_objective Objective>
[[nodiscard]] capture_plan descend(const Geometry& geometry, const Objective& objective, capture_plan plan,
                                   std::uint64_t seed = 0) {
  std::mt19937_64 generator(seed);
  plan.value = objective(std::span<const Eigen::Index>(plan.candidates));
  std::vector<Eigen::Index> order(plan.candidates.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  for (const int distance : {3, 1}) {
    bool improved = true;
    while (improved) {
      improved = false;
      std::ranges::shuffle(order, generator);
      for (const Eigen::Index position : order)
        while (detail::move_one(geometry, objective, plan, position, distance)) improved = true;
    }
  }
  plan.value = objective(std::span<const Eigen::Index>(plan.candidates));  // removes the rounding of many steps
  return plan;
}

/// Adds candidates one by one, each the best of `tries` random ones, and calls `descend` after each. One try is close
/// to the search of Nielsen et al.; 500 tries are the search of Xu et al. Throws gonio::error unless n is from 1 to the
/// number of allowed candidates.
template <capture_geometry Geometry, plan_objective Objective>
[[nodiscard]] capture_plan grow_and_descend(const Geometry& geometry, const Objective& objective, Eigen::Index n,
                                            Eigen::Index tries = 500, std::uint64_t seed = 0,
                                            const progress& listener = {}) {
  detail::require_choice(n, geometry);
  std::mt19937_64 generator(seed);
  capture_plan plan;
  while (std::ssize(plan.candidates) < n) {
    const Eigen::Index added = plan.candidates.size();
    plan.candidates.push_back(detail::another_candidate(plan.candidates, geometry, generator));
    const auto value_with = detail::value_of_replacement(objective, plan.candidates, added);
    double best = value_with(plan.candidates[added]);
    const std::vector<Eigen::Index> others = detail::without(plan.candidates, added);
    for (Eigen::Index i = 1; i < tries; ++i) {
      const Eigen::Index candidate = detail::another_candidate(others, geometry, generator);
      const double value = value_with(candidate);
      if (!(value < best)) continue;
      best = value;
      plan.candidates[added] = candidate;
    }
    plan = descend(geometry, objective, std::move(plan), generator());
    report(listener, "measurements", static_cast<double>(plan.candidates.size()) / static_cast<double>(n));
  }
  return plan;
}

/// Starts with n random candidates. Then, `swaps` times, replaces a random member of the plan by a random new candidate
/// if that improves the plan. This is the search of Matusik et al., the baseline. Throws gonio::error unless n is from
/// 1 to the number of allowed candidates.
template <capture_geometry Geometry, plan_objective Objective>
[[nodiscard]] capture_plan swap_at_random(const Geometry& geometry, const Objective& objective, Eigen::Index n,
                                          Eigen::Index swaps, std::uint64_t seed = 0) {
  detail::require_choice(n, geometry);
  std::mt19937_64 generator(seed);
  capture_plan plan;
  while (std::ssize(plan.candidates) < n)
    plan.candidates.push_back(detail::another_candidate(plan.candidates, geometry, generator));
  plan.value = objective(std::span<const Eigen::Index>(plan.candidates));
  std::uniform_int_distribution<Eigen::Index> any_position(0, n - 1);
  for (Eigen::Index swap = 0; swap < swaps; ++swap) {
    const Eigen::Index position = any_position(generator);
    const std::vector<Eigen::Index> others = detail::without(plan.candidates, position);
    const Eigen::Index candidate = detail::another_candidate(others, geometry, generator);
    const double value = detail::value_of_replacement(objective, plan.candidates, position)(candidate);
    if (!detail::improves(value, plan.value)) continue;
    plan.candidates[position] = candidate;
    plan.value = value;
  }
  return plan;
}

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/search.ipp>
#endif
