/// Correction functions on real materials: the basis, one round of the iteration for three channels, and what the
/// machine could do: a rank update by Eigen on as many rows, and a copy of as many bytes.

#include "../real_materials.hpp"
#include <gonio/estimate/correction_iteration.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/robust_reconstruction.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/metric/log.hpp>

#include <benchmark/benchmark.h>

#include <concepts>

namespace {

const gonio::material_set& materials() {
  static const auto set = real_materials();
  return set;
}

/// All but the material that is measured.
const gonio::measured<gonio::log>& others() {
  static const auto basis = gonio::measured{materials(), gonio::log{}}.without({"blue-acrylic"});
  return basis;
}

const gonio::correction& corrections() {
  static const gonio::correction functions{others()};
  return functions;
}

/// Blue acrylic at one cell in `step`, a fifth of the measurements outliers.
gonio::located_samples samples(std::int64_t step) {
  const auto truth = materials().table(materials().find("blue-acrylic"));
  const std::size_t count = truth.cells().size() / step;
  return gonio::locate_samples(truth.cells(), gonio::sample_table(truth, gonio::random_cells(truth.cells(), count, 1),
                                                                  {.outlier_ratio = 0.2}, 1));
}

/// Multiplications and additions of the normal equations of three channels.
double operations(const gonio::located_samples& measured) {
  const auto k = static_cast<double>(corrections().size() + 1);
  return 3.0 * static_cast<double>(measured.size()) * k * (k + 1.0);
}

template <class Weighting>
void one_round(benchmark::State& state, const Weighting& weighting) {
  const auto measured = samples(state.range(0));
  const auto initial = gonio::decomposition{others(), gonio::nnls{}}.fit(
      gonio::sample_set{{materials().cells.angles(0), gonio::rgb(0.1, 0.1, 0.1), 1.0}});
  gonio::correction_run run{initial, corrections(), measured, weighting};
  run.step();
  for (auto _ : state) benchmark::DoNotOptimize(run.step());
  if constexpr (!std::same_as<Weighting, gonio::trust_all>)
    state.counters["GF/s"] =
        benchmark::Counter(operations(measured) * 1e-9, benchmark::Counter::kIsIterationInvariantRate);
  // A round that builds no normal equations reads the rows twice: moments, and the correction at the samples.
  state.counters["GB/s"] = benchmark::Counter(2.0 * 12e-9 * static_cast<double>(measured.size() * corrections().size()),
                                              benchmark::Counter::kIsIterationInvariantRate);
}

void round_with_weights(benchmark::State& state) { one_round(state, gonio::relative_deviation_weights{3.0}); }
BENCHMARK(round_with_weights)->Arg(1)->Arg(10)->UseRealTime()->Unit(benchmark::kMillisecond);

void round_with_automatic_weights(benchmark::State& state) { one_round(state, gonio::automatic_weights{}); }
BENCHMARK(round_with_automatic_weights)->Arg(1)->Arg(10)->UseRealTime()->Unit(benchmark::kMillisecond);

void round_with_fixed_weights(benchmark::State& state) { one_round(state, gonio::trust_all{}); }
BENCHMARK(round_with_fixed_weights)->Arg(1)->Arg(10)->UseRealTime()->Unit(benchmark::kMillisecond);

void correction_basis(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(gonio::correction{others()});
}
BENCHMARK(correction_basis)->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(2);

void whole_robust_reconstruction(benchmark::State& state) {
  const auto measured = samples(state.range(0));
  gonio::sample_set set;
  for (Eigen::Index i = 0; i < measured.size(); ++i)
    set.push_back({measured.locations[i].angles, measured.values.row(i).transpose().array(), 1.0});
  const gonio::robust_reconstruction estimator{others(), corrections()};
  for (auto _ : state) benchmark::DoNotOptimize(estimator.fit(set).tabulate(materials().cells));
}
BENCHMARK(whole_robust_reconstruction)->Arg(1)->Arg(10)->Arg(1000)->UseRealTime()->Unit(benchmark::kMillisecond);

/// The yardstick: Eigen's rank update in float over the same rows, in blocks that fit into the cache, on two threads.
void eigen_rank_update(benchmark::State& state) {
  const auto channel = corrections().channel(1);
  const std::size_t rows = channel.values().rows();
  const Eigen::Index k = std::ssize(corrections());
  const Eigen::MatrixXf zero = Eigen::MatrixXf::Zero(k, k);
  for (auto _ : state) {
    const Eigen::MatrixXf sum = gonio::sum_over_blocks(rows, 256, zero, [&](Eigen::MatrixXf& part, gonio::block range) {
      const Eigen::MatrixXf block = channel.values().middleRows(range.begin, range.size());
      part.selfadjointView<Eigen::Lower>().rankUpdate(block.transpose());
    });
    benchmark::DoNotOptimize(sum.data());
  }
  state.counters["GF/s"] = benchmark::Counter(static_cast<double>(rows) * static_cast<double>(k * (k + 1)) * 1e-9,
                                              benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(eigen_rank_update)->UseRealTime()->Unit(benchmark::kMillisecond);

/// The other yardstick: reading a channel's rows.
void read_rows(benchmark::State& state) {
  const auto channel = corrections().channel(1);
  const std::size_t rows = channel.values().rows();
  for (auto _ : state) {
    const double sum = gonio::sum_over_blocks(rows, 4096, 0.0, [&](double& part, gonio::block range) {
      part += static_cast<double>(channel.values().middleRows(range.begin, range.size()).sum());
    });
    benchmark::DoNotOptimize(sum);
  }
  state.counters["GB/s"] = benchmark::Counter(4e-9 * static_cast<double>(rows * corrections().size()),
                                              benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(read_rows)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
