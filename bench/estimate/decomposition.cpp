/// Reconstruction of a full RGB 90 x 90 x 180 table from 20 samples with the shipped prior: the solve, and the
/// expansion, compared with its unavoidable work done by Eigen and with a plain copy of the same bytes.

#include "../limit.hpp"
#include <gonio/design/published_directions.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Core>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstring>
#include <memory>

namespace {

const gonio::log_relative_pca& prior() {
  static const auto shipped = gonio::io::read_prior(GONIO_SOURCE_PRIOR);
  return shipped;
}

const gonio::valid_cells& cells() {
  static const gonio::valid_cells merl;
  return merl;
}

const gonio::sample_set& samples() {
  static const auto measured = [] {
    const auto truth = gonio::tabulate(gonio::model::formula_material("red-paint"), cells());
    return gonio::sample_table(truth, gonio::cells_at(cells(), gonio::design::nielsen_directions(20)));
  }();
  return measured;
}

/// Returns the bytes of the result: 3 floats per valid cell.
std::int64_t table_bytes() { return static_cast<std::int64_t>(3 * sizeof(float) * cells().size()); }

/// Returns the bytes that an expansion must move: the basis once, and the result.
std::int64_t moved_bytes() {
  return table_bytes() + static_cast<std::int64_t>(sizeof(float) * (prior().size() + 2) * prior().cells().size());
}

void solve(benchmark::State& state) {
  const gonio::decomposition estimator{prior(), gonio::tikhonov{40.0}};
  for (auto _ : state) benchmark::DoNotOptimize(estimator.fit(samples()));
}
BENCHMARK(solve)->Unit(benchmark::kMicrosecond);

void expand(benchmark::State& state) {
  const auto fit = gonio::decomposition{prior(), gonio::tikhonov{40.0}}.fit(samples());
  for (auto _ : state) benchmark::DoNotOptimize(fit.tabulate(cells(), {static_cast<unsigned>(state.range(0))}));
  state.SetBytesProcessed(state.iterations() * moved_bytes());
  limited_by(state, "product_and_exponentials/" + std::to_string(state.range(0)));
}
BENCHMARK(expand)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

/// The simple version that the tests compare with.
void expand_cell_by_cell(benchmark::State& state) {
  const auto fit = gonio::decomposition{prior(), gonio::tikhonov{40.0}}.fit(samples());
  for (auto _ : state) benchmark::DoNotOptimize(fit.tabulate_cells(cells(), {2}));
  state.SetBytesProcessed(state.iterations() * moved_bytes());
}
BENCHMARK(expand_cell_by_cell)->UseRealTime()->Unit(benchmark::kMillisecond);

/// Multiplies the components with the weights, one column at a time, which is faster in Eigen than three at once.
void multiply_by_eigen(Eigen::MatrixX3f& product, const Eigen::MatrixX3f& weights, gonio::thread_count threads) {
  const auto& components = prior().components();
  gonio::for_each_block(
      components.rows(), 64,
      [&](gonio::block range) {
        for (Eigen::Index channel = 0; channel < 3; ++channel)
          product.col(channel).segment(range.begin, range.size()).noalias() =
              components.middleRows(range.begin, range.size()) * weights.col(channel);
      },
      threads);
}

/// Writes exponentials of four numbers per cell (three channels and the reference) that are in the cache.
void exponentiate_by_eigen(float* table, gonio::thread_count threads) {
  constexpr Eigen::Index at_once = 256;
  const Eigen::ArrayXf logarithms = Eigen::ArrayXf::Random(4 * at_once);
  gonio::for_each_block(
      cells().size(), at_once,
      [&](gonio::block range) {
        Eigen::Array<float, 4 * at_once, 1> exponentials = logarithms.exp();
        benchmark::DoNotOptimize(exponentials.data());
        std::copy_n(exponentials.data(), 3 * range.size(), table + 3 * range.begin);
      },
      threads);
}

/// The limit: the product with the prior's components, an exponential per number, and writing a new table, all by
/// Eigen, without interpolation between the prior's cells.
void product_and_exponentials(benchmark::State& state) {
  const gonio::thread_count threads{static_cast<unsigned>(state.range(0))};
  const Eigen::MatrixX3f weights = Eigen::MatrixX3f::Random(prior().size(), 3);
  for (auto _ : state) {
    Eigen::MatrixX3f product(prior().cells().size(), 3);
    multiply_by_eigen(product, weights, threads);
    benchmark::DoNotOptimize(product.data());
    const std::unique_ptr<float[]> table(new float[3 * cells().size()]);
    exponentiate_by_eigen(table.get(), threads);
    benchmark::DoNotOptimize(table.get());
  }
  state.SetBytesProcessed(state.iterations() * moved_bytes());
}
BENCHMARK(product_and_exponentials)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

/// The limit of memory: writing a new table by copying as many bytes as an expansion reads and writes.
void copy(benchmark::State& state) {
  const std::vector<char> from(moved_bytes() / 2, 1);
  const auto threads = static_cast<unsigned>(state.range(0));
  for (auto _ : state) {
    const std::unique_ptr<char[]> to(new char[from.size()]);
    gonio::for_each_block(std::ssize(from), 1 << 18,
                          [&](gonio::block range) { std::memcpy(&to[range.begin], &from[range.begin], range.size()); },
                          {threads});
    benchmark::DoNotOptimize(to.get());
  }
  state.SetBytesProcessed(state.iterations() * moved_bytes());
}
BENCHMARK(copy)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
