/// The cost of a design with all components of 90 materials over all cells of MERL's grid (or the shipped prior's):
/// E(S) of 20 samples, the set-up of the candidates, and sweeps over all cells as the next sample, compared with
/// reading as many bytes.

#include "../limit.hpp"
#include "../real_materials.hpp"
#include <gonio/basis/learn_pca.hpp>
#include <gonio/design/cell_candidates.hpp>
#include <gonio/design/exhaustive_search.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <numeric>

namespace {

/// Both cores of the machine that gave the documented figures.
constexpr gonio::thread_count threads{2};

const gonio::log_relative_pca& prior() {
  static const auto learned = [] {
    gonio::material_set materials = real_materials();
    std::vector<Eigen::Index> first(std::min<std::size_t>(materials.names.size(), 90));
    std::iota(first.begin(), first.end(), std::size_t{0});
    gonio::material_set training = materials.subset(first);
    const auto metric = gonio::log_relative::to_median_of(training, threads);
    auto pca = gonio::learn_pca(std::move(training), metric, 300, threads);
    std::cerr << pca.cells().size() << " cells, " << pca.size() << " components, " << pca.coefficients().rows()
              << " observations\n";
    return pca;
  }();
  return learned;
}

/// Returns the number of entries of Y, and of W.
double entries() {
  return static_cast<double>(prior().components().rows()) * static_cast<double>(prior().coefficients().rows());
}

const gonio::design::cell_candidates& candidates() {
  static const gonio::design::cell_candidates all(prior(), gonio::design::expected_error(prior()), {}, threads);
  return all;
}

/// Leaves each material out of the prior that reconstructs it, the default of `gonio design`.
const gonio::design::cell_candidates& candidates_left_out() {
  static const gonio::design::cell_candidates all(prior(), gonio::design::expected_error(prior(), {.leave_out = true}),
                                                  {}, threads);
  return all;
}

/// Returns cells that are far apart.
std::vector<Eigen::Index> some_cells(std::size_t count) {
  std::vector<Eigen::Index> cells;
  for (std::size_t i = 0; i < count; ++i) cells.push_back((i * 7919 + 13) * 137 % candidates().size());
  return cells;
}

void error_of_20(benchmark::State& state) {
  const auto cells = some_cells(20);
  for (auto _ : state) benchmark::DoNotOptimize(candidates()(cells));
}
BENCHMARK(error_of_20)->Unit(benchmark::kMicrosecond);

/// As in a descent: the other 19 stay fixed.
void error_of_one_beside_19(benchmark::State& state) {
  const auto cells = some_cells(19);
  const auto with = candidates().beside(cells);
  std::size_t cell = 0;
  for (auto _ : state) benchmark::DoNotOptimize(with(cell = (cell + 4099) % candidates().size()));
}
BENCHMARK(error_of_one_beside_19)->Unit(benchmark::kMicrosecond);

void set_up(benchmark::State& state) {
  static_cast<void>(prior());
  for (auto _ : state) {
    const gonio::design::cell_candidates all(prior(), gonio::design::expected_error(prior()), {}, threads);
    benchmark::DoNotOptimize(all.size());
  }
  count_operations(state, 4.0 * entries() * static_cast<double>(prior().size()));
  limited_by(state, "product");
}
BENCHMARK(set_up)->UseRealTime()->Unit(benchmark::kSecond)->Iterations(2);

/// Counts the bytes of Y and W, which a sweep reads once, and its operations with n measurements: per entry of Y, 10 n
/// for the products and `end` for the final step, including a square root.
void measure_sweep(benchmark::State& state, const gonio::design::cell_candidates& all, double end) {
  const auto n = static_cast<std::size_t>(state.range(0));
  const auto cells = some_cells(n);
  for (auto _ : state) benchmark::DoNotOptimize(all.errors_with_each(cells).data());
  count_bytes(state, 8.0 * entries());
  count_operations(state, entries() * (10.0 * static_cast<double>(n) + end));
  limited_by(state, "read_as_many_bytes; product");
}

void sweep(benchmark::State& state) { measure_sweep(state, candidates(), 12.0); }
BENCHMARK(sweep)->Arg(0)->Arg(1)->Arg(10)->Arg(19)->UseRealTime()->Unit(benchmark::kMillisecond);

/// Per material, 18 operations for each of X and L, 24 for an adjugate, 60 for three squares: 44 per entry.
void sweep_left_out(benchmark::State& state) { measure_sweep(state, candidates_left_out(), 44.0); }
BENCHMARK(sweep_left_out)->Arg(0)->Arg(1)->Arg(10)->Arg(19)->UseRealTime()->Unit(benchmark::kMillisecond);

/// The yardsticks of this machine: reading as many bytes, and Eigen's product of floats on both cores.
void read_as_many_bytes(benchmark::State& state) {
  const std::size_t count = (2 * prior().coefficients().rows()) * candidates().size();
  const std::vector<float> values(count, 1.0f);
  for (auto _ : state) {
    std::vector<float> sums((count + 65535) / 65536);
    gonio::for_each_block(
        sums.size(), 1,
        [&](gonio::block range) {
          const std::size_t begin = range.begin * 65536, size = std::min<std::size_t>(65536, count - begin);
          sums[range.begin] = Eigen::Map<const Eigen::ArrayXf>(values.data() + begin, size).sum();
        },
        threads);
    benchmark::DoNotOptimize(sums.data());
  }
  count_bytes(state, 4.0 * static_cast<double>(count));
}
BENCHMARK(read_as_many_bytes)->UseRealTime()->Unit(benchmark::kMillisecond);

void product(benchmark::State& state) {
  constexpr Eigen::Index size = 1024;
  const Eigen::MatrixXf a = Eigen::MatrixXf::Ones(size, size);
  std::array<Eigen::MatrixXf, 2> results;
  for (auto _ : state)
    gonio::for_each_block(
        2, 1, [&](gonio::block range) { results[range.begin].noalias() = a * a; }, threads);
  benchmark::DoNotOptimize(results[0].data());
  count_operations(state, 2.0 * 2.0 * size * size * size);
}
BENCHMARK(product)->UseRealTime()->Unit(benchmark::kMillisecond);

void grow_20(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(gonio::design::grow_greedily(candidates(), 20).value);
}
BENCHMARK(grow_20)->UseRealTime()->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
