#pragma once
/// Searches that try every candidate as the next measurement, which Xu et al. 2016 (doi:10.1145/2980179.2982396) could
/// not afford: greedy growth, and Fedorov's exchange (1972), which stops if no exchange of one measurement for another
/// improves the plan.

#include <gonio/design/search.hpp>

#include <Eigen/Core>

namespace gonio::design {

/// An objective that also evaluates, in one call, a set of candidates with each other candidate added in turn. The
/// value is infinity if the added candidate is not allowed.
///
/// An objective may offer `best_beside(candidates)`, which returns the best candidate to add that is not in the set
/// and, if several are equally good, the one with the lowest number. The searches then call `best_beside`, so an
/// objective can distribute the work.
template <class Objective>
concept sweeping_objective = plan_objective<Objective> &&
    requires(const Objective& objective, std::span<const Eigen::Index> candidates) {
  { objective.geometry() } -> capture_geometry;
  { objective.errors_with_each(candidates) } -> std::same_as<std::vector<float>>;
};

namespace detail {

/// Returns the best candidate to add to a plan, among those not in it.
template <sweeping_objective Objective>
[[nodiscard]] Eigen::Index best_addition(const Objective& objective, std::span<const Eigen::Index> plan) {
  if constexpr (requires { objective.best_beside(plan); }) return objective.best_beside(plan);
  std::vector<float> errors = objective.errors_with_each(plan);
  for (const Eigen::Index candidate : plan) errors[candidate] = std::numeric_limits<float>::infinity();
  return std::ranges::min_element(errors) - errors.begin();
}

}  // namespace detail

/// Adds the best of all candidates to `plan` until the plan has n candidates. The first k candidates are the plan that
/// the same search finds for k. Throws gonio::error unless n is from 1 to the number of allowed candidates.
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

/// Replaces one candidate of the plan after another by the best of all candidates, until no replacement improves the
/// plan. Each round makes n sweeps over all candidates. Compares in double. Ignores relative improvements below 1e-6,
/// which float cannot resolve.
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
      without_improvement = 1;  // this candidate is now the best at its position
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
