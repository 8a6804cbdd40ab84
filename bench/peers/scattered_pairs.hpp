#pragma once
/// Pairs of directions above the horizon, uniform in solid angle, and a BRDF with varying values.

#include <gonio/core/direction.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/rgb.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

inline const std::vector<std::pair<gonio::direction, gonio::direction>>& scattered_pairs() {
  static const auto all = [] {
    std::mt19937_64 generator(1);
    const auto any = [&] {
      return gonio::spherical_direction(std::acos(1e-3 + 0.998 * gonio::uniform_number(generator)),
                                        6.28 * gonio::uniform_number(generator));
    };
    std::vector<std::pair<gonio::direction, gonio::direction>> pairs;
    for (int i = 0; i < 1 << 16; ++i) {
      const gonio::direction wi = any();
      pairs.emplace_back(wi, any());
    }
    return pairs;
  }();
  return all;
}

struct some_material {
  gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
    return gonio::rgb(0.1 + wi.z() * wo.z(), 0.2, 0.3 + std::pow((wi + wo).normalized().z(), 50));
  }
};

/// Evaluates the pairs in another library's types, and sums the results.
template <class Vector, class Number, class Evaluate>
void look_up_pairs(benchmark::State& state, const Evaluate& evaluate) {
  std::vector<std::pair<Vector, Vector>> pairs;
  const auto copy = [](const gonio::direction& w) {
    return Vector(static_cast<Number>(w.x()), static_cast<Number>(w.y()), static_cast<Number>(w.z()));
  };
  for (const auto& [wi, wo] : scattered_pairs()) pairs.emplace_back(copy(wi), copy(wo));
  for (auto _ : state) {
    double sum = 0.0;
    for (const auto& [wi, wo] : pairs) sum += evaluate(wi, wo);
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs.size()));
}
