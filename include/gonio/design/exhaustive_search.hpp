#pragma once
/// Searches that try every candidate as the next measurement, which Xu et al. 2016 (doi:10.1145/2980179.2982396) could
/// not afford: greedy growth, exchange until no replacement of one measurement by any other is an improvement
/// (Fedorov's exchange, 1972), and both.

#include <gonio/design/search.hpp>

#include <Eigen/Core>

namespace gonio::design {

/// An objective that also tells, all at once, what a set is worth with each of all candidates beside it; infinity for
/// those that are not allowed.
///
/// An objective may offer `best_beside(candidates)`, the one that is worth most beside some, none of them again; of
/// equal ones that with the lowest number. Searches then ask it, and who implements it may share the work.
template <class Objective>
concept sweeping_objective = plan_objective<Objective> &&
    requires(const Objective& objective, std::span<const Eigen::Index> candidates) {
  { objective.geometry() } -> capture_geometry;
  { objective.errors_with_each(candidates) } -> std::same_as<std::vector<float>>;
};

namespace detail {

/// The candidate that is worth most beside those of a plan, none of them again.
template <sweeping_objective Objective>
[[nodiscard]] Eigen::Index best_addition(const Objective& objective, std::span<const Eigen::Index> plan) {
  if constexpr (requires { objective.best_beside(plan); }) return objective.best_beside(plan);
  std::vector<float> errors = objective.errors_with_each(plan);
  for (const Eigen::Index candidate : plan) errors[candidate] = std::numeric_limits<float>::infinity();
  return std::ranges::min_element(errors) - errors.begin();
}

}  // namespace detail

/// Adds the best of all candidates until there are n: a longer plan begins with the shorter one. Throws gonio::error
/// unless n is from 1 to the number of candidates.
template <sweeping_objective Objective>
[[nodiscard]] capture_plan grow_greedily(const Objective& objective, Eigen::Index n, capture_plan plan = {},
                                         const progress& listener = {}) {
  detail::require_choice(n, objective.geometry());
  while (std::ssize(plan.candidates) < n) {
    plan.candidates.push_back(detail::best_addition(objective, plan.candidates));
    report(listener, "measurements", static_cast<double>(plan.candidates.size()) / static_cast<double>(n));
  }
  plan.value = objective(plan.candidates);
  return plan;
}

/// Replaces one candidate after another by the best of all, until no replacement improves: n sweeps over all candidates
/// a round. Values are compared in double; improvements below a millionth, which float does not see, are none.
template <sweeping_objective Objective>
[[nodiscard]] capture_plan exchange(const Objective& objective, capture_plan plan, const progress& listener = {}) {
  plan.value = objective(plan.candidates);
  Eigen::Index without_improvement = 0, position = 0;
  while (without_improvement < std::ssize(plan.candidates)) {
    capture_plan other = plan;
    other.candidates[position] = detail::best_addition(objective, detail::without(plan.candidates, position));
    other.value = objective(other.candidates);
    if (detail::improves(other.value, plan.value, 1e-6)) {
      plan = std::move(other);
      without_improvement = 1;  // this one is the best in its place now
    } else {
      ++without_improvement;
    }
    position = (position + 1) % plan.candidates.size();
    report(listener, "exchange",
           static_cast<double>(without_improvement) / static_cast<double>(plan.candidates.size()));
  }
  return plan;
}

}  // namespace gonio::design
