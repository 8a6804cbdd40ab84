/// Finding a MERL cell for scattered pairs of directions: the obvious way with arc functions, `grid::nearest`, and
/// `cell_finder`; and the same with the table's value, of which the difference is the wait for memory.

#include <gonio/render/cell_finder.hpp>
#include <gonio/table/grid.hpp>

#include <benchmark/benchmark.h>

#include <random>

namespace {

template <class Real>
using vector3 = Eigen::Matrix<Real, 3, 1>;

/// Pairs above the horizon, uniform in solid angle.
template <class Real>
const std::vector<std::pair<vector3<Real>, vector3<Real>>>& pairs() {
  static const auto all = [] {
    std::mt19937_64 generator(1);
    std::uniform_real_distribution<double> uniform(1e-3, 1.0);
    std::vector<std::pair<vector3<Real>, vector3<Real>>> made;
    const auto any = [&] {
      const double theta = std::acos(uniform(generator));
      return vector3<Real>(gonio::spherical_direction(theta, 6.28 * uniform(generator)).cast<Real>());
    };
    for (int i = 0; i < 1 << 16; ++i) {
      const auto wi = any();
      made.emplace_back(wi, any());
    }
    return made;
  }();
  return all;
}

const std::vector<std::array<float, 3>>& table() {
  static const std::vector<std::array<float, 3>> values(90 * 90 * 180, {0.1f, 0.2f, 0.3f});
  return values;
}

/// Half vector, rotation by its angles, acos and atan2: as one would write it down from the definition.
std::size_t obvious(const Eigen::Vector3d& wi, const Eigen::Vector3d& wo) {
  const Eigen::Vector3d h = (wi + wo).normalized();
  const double theta_h = std::acos(h.z()), phi_h = std::atan2(h.y(), h.x());
  const double c = std::cos(-phi_h), s = std::sin(-phi_h);
  const Eigen::Vector3d turned(c * wi.x() - s * wi.y(), s * wi.x() + c * wi.y(), wi.z());
  const double ct = std::cos(-theta_h), st = std::sin(-theta_h);
  const Eigen::Vector3d d(ct * turned.x() + st * turned.z(), turned.y(), ct * turned.z() - st * turned.x());
  const double theta_d = std::acos(std::min(d.z(), 1.0));
  double phi_d = std::atan2(d.y(), d.x());
  if (phi_d < 0.0) phi_d += std::numbers::pi;
  const auto index = [](double share, int cells) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(share * cells), 0, cells - 1));
  };
  constexpr double half_pi = std::numbers::pi / 2.0;
  return (index(std::sqrt(theta_h / half_pi), 90) * 90 + index(theta_d / half_pi, 90)) * 180 +
         index(phi_d / std::numbers::pi, 180);
}

template <class Real, class Find>
void find_all(benchmark::State& state, const Find& find, bool reads) {
  const auto& all = pairs<Real>();
  const auto& values = table();
  for (auto _ : state) {
    std::size_t sum = 0;
    float red = 0.0f;
    for (const auto& [wi, wo] : all) {
      const std::size_t cell = find(wi, wo);
      sum += cell;
      if (reads) red += values[cell][0];
    }
    benchmark::DoNotOptimize(sum);
    benchmark::DoNotOptimize(red);
  }
  state.SetItemsProcessed(state.iterations() * std::ssize(all));
}

void with_arc_functions(benchmark::State& state) { find_all<double>(state, obvious, state.range(0) != 0); }

void by_grid(benchmark::State& state) {
  const gonio::grid cells;
  const auto find = [&](const auto& wi, const auto& wo) {
    return cells.linear(cells.nearest(gonio::to_half_difference(wi, wo)));
  };
  find_all<double>(state, find, state.range(0) != 0);
}

template <class Real>
void by_cell_finder(benchmark::State& state) {
  find_all<Real>(state, gonio::cell_finder<Real>(), state.range(0) != 0);
}

BENCHMARK(with_arc_functions)->ArgName("reads")->Arg(0)->Arg(1);
BENCHMARK(by_grid)->ArgName("reads")->Arg(0)->Arg(1);
BENCHMARK(by_cell_finder<double>)->ArgName("reads")->Arg(0)->Arg(1);
BENCHMARK(by_cell_finder<float>)->ArgName("reads")->Arg(0)->Arg(1);

}  // namespace
