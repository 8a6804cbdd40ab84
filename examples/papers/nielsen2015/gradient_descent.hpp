#pragma once
/// The search of Nielsen et al. 2015, section 4, as printed: it moves candidates along the numerical gradient. The
/// library's own search, `gonio::design::descend`, moves them to the best of six neighbours.

#include <gonio/core/progress.hpp>
#include <gonio/design/search.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace papers {

/// Returns the step of `length` cells down the gradient, from central differences, one-sided at an edge.
/// `value_at(candidate)` returns the plan's value with a candidate in place of `from`.
template <gonio::design::capture_geometry Geometry, class Value>
[[nodiscard]] gonio::design::grid_step step_down(const Geometry& geometry, Eigen::Index from, double here, int length,
                                                 const Value& value_at) {
  std::array<double, 3> gradient{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<double, 2> beside{here, here};
    int apart = 0;
    for (const int side : {0, 1}) {
      gonio::design::grid_step step{};
      step[axis] = 2 * side - 1;
      const std::optional<Eigen::Index> neighbour = geometry.stepped(from, step);
      const double value = neighbour ? value_at(*neighbour) : std::numeric_limits<double>::infinity();
      if (!std::isfinite(value)) continue;
      beside[side] = value;
      ++apart;
    }
    if (apart > 0) gradient[axis] = (beside[1] - beside[0]) / apart;
  }
  gonio::design::grid_step step{};
  const double norm = std::hypot(gradient[0], gradient[1], gradient[2]);
  for (std::size_t axis = 0; axis < 3 && norm > 0.0; ++axis)
    step[axis] = -static_cast<int>(std::lround(length * gradient[axis] / norm));
  return step;
}

/// Returns the candidate at the end of a step. If there is no candidate, first sets the step to 0 along each axis whose
/// step alone leads to no candidate ("clip accordingly").
template <gonio::design::capture_geometry Geometry>
[[nodiscard]] std::optional<Eigen::Index> stepped_or_clipped(const Geometry& geometry, Eigen::Index from,
                                                             gonio::design::grid_step step) {
  if (const auto to = geometry.stepped(from, step)) return to;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    gonio::design::grid_step alone{};
    alone[axis] = step[axis];
    if (!geometry.stepped(from, alone)) step[axis] = 0;
  }
  return geometry.stepped(from, step);
}

/// Moves the candidates of a plan in random order along the gradient while this improves the plan, with one step length
/// after the other.
template <gonio::design::capture_geometry Geometry, gonio::design::plan_objective Objective>
[[nodiscard]] gonio::design::capture_plan descend_along_gradient(const Geometry& geometry, const Objective& objective,
                                                                 gonio::design::capture_plan plan, std::uint64_t seed,
                                                                 const std::vector<int>& lengths = {3, 1}) {
  std::mt19937_64 generator(seed);
  plan.value = objective(std::span<const Eigen::Index>(plan.candidates));
  const auto move = [&](std::size_t position, int length) {
    const auto value_at = [&](Eigen::Index candidate) {
      if (std::ranges::find(plan.candidates, candidate) != plan.candidates.end())
        return std::numeric_limits<double>::infinity();
      std::vector<Eigen::Index> moved = plan.candidates;
      moved[position] = candidate;
      return objective(std::span<const Eigen::Index>(moved));
    };
    const Eigen::Index from = plan.candidates[position];
    const auto to = stepped_or_clipped(geometry, from, step_down(geometry, from, plan.value, length, value_at));
    if (!to || *to == from) return false;
    const double value = value_at(*to);
    if (!(value < plan.value)) return false;
    plan.candidates[position] = *to;
    plan.value = value;
    return true;
  };
  std::vector<std::size_t> order(plan.candidates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (const int length : lengths)
    for (bool moved = true; moved;) {
      moved = false;
      std::ranges::shuffle(order, generator);
      for (const std::size_t position : order)
        while (move(position, length)) moved = true;
    }
  return plan;
}

/// Returns plans of 1 to `most` measurements. Each adds a random candidate to the previous one (r = 1, step 4);
/// `descent(plan, seed)` then improves it.
template <gonio::design::capture_geometry Geometry, class Descent>
[[nodiscard]] std::vector<gonio::design::capture_plan> grown_plans(const Geometry& geometry, std::size_t most,
                                                                   std::uint64_t seed, const Descent& descent,
                                                                   const gonio::progress& listener = {}) {
  std::mt19937_64 generator(seed);
  std::uniform_int_distribution<Eigen::Index> any(0, geometry.size() - 1);
  std::vector<gonio::design::capture_plan> plans;
  gonio::design::capture_plan plan;
  while (plans.size() < most) {
    Eigen::Index added = any(generator);
    while (!geometry.allows(added) || std::ranges::find(plan.candidates, added) != plan.candidates.end())
      added = any(generator);
    plan.candidates.push_back(added);
    plan = descent(std::move(plan), generator());
    plans.push_back(plan);
    gonio::report(listener, "condition", static_cast<double>(plans.size()) / static_cast<double>(most));
  }
  return plans;
}

/// Runs the paper's search for n measurements.
template <gonio::design::capture_geometry Geometry, gonio::design::plan_objective Objective>
[[nodiscard]] gonio::design::capture_plan grow_along_gradient(const Geometry& geometry, const Objective& objective,
                                                              std::size_t n, std::uint64_t seed,
                                                              const std::vector<int>& lengths = {3, 1}) {
  return grown_plans(geometry, n, seed,
                     [&](gonio::design::capture_plan plan, std::uint64_t order) {
                       return descend_along_gradient(geometry, objective, std::move(plan), order, lengths);
                     })
      .back();
}

}  // namespace papers
