/// Correction functions on real materials: the basis and one round of the iteration for three channels. Compared with
/// Eigen's rank update of as many rows and a copy of as many bytes.

#include "../limit.hpp"
#include "../real_materials.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/robust/correction_iteration.hpp>
#include <gonio/robust/robust_reconstruction.hpp>

#include <benchmark/benchmark.h>

#include <array>
#include <concepts>

namespace {

const gonio::material_set& materials() {
  static const auto set = real_materials();
  return set;
}

/// All materials except the measured one.
const gonio::measured<gonio::log>& others() {
  static const auto basis = gonio::measured{materials(), gonio::log{}}.without({"blue-acrylic"});
  return basis;
}

const gonio::correction& corrections() {
  static const gonio::correction functions{others()};
  return functions;
}

/// Samples blue acrylic at 1 / step of the cells, chosen at random; a fifth of the measurements are outliers.
gonio::located_samples samples(std::int64_t step) {
  const auto truth = materials().table(materials().find("blue-acrylic"));
  const std::size_t count = truth.cells().size() / step;
  return gonio::locate_samples(truth.cells(), gonio::sample_table(truth, gonio::random_cells(truth.cells(), count, 1),
                                                                  {.outlier_ratio = 0.2}, 1));
}

/// Returns the number of samples and channels that count in a run's next round. Outliers' weights may be negligible.
template <class Run>
double counted(const Run& run) {
  const gonio::channel_values weights = run.inlier_weights(), sized = weights * run.sigma().abs().max(1.0f);
  double count = 0.0;
  for (Eigen::Index c = 0; c < 3; ++c)
    count += static_cast<double>((sized.row(c) >= 1e-6f * weights.row(c).maxCoeff()).count());
  return count;
}

/// Returns the multiplications and additions of the normal equations of some samples.
double operations(double samples) {
  const auto k = static_cast<double>(corrections().size() + 1);
  return samples * k * (k + 1.0);
}

template <class Weighting>
void one_round(benchmark::State& state, const Weighting& weighting) {
  const auto measured = samples(state.range(0));
  const auto initial = gonio::decomposition{others(), gonio::nnls{}}.fit(
      gonio::sample_set{{materials().cells.angles(0), gonio::rgb(0.1, 0.1, 0.1), 1.0}});
  gonio::correction_run run{initial, corrections(), measured, weighting};
  run.step();
  const double samples_that_count = counted(run);
  for (auto _ : state) benchmark::DoNotOptimize(run.step());
  // A round without normal equations reads the rows twice: for the right-hand sides, and to evaluate the correction.
  constexpr bool assembles = !std::same_as<Weighting, gonio::equal_weights>;
  if (assembles) count_operations(state, operations(samples_that_count));
  if (!assembles) count_bytes(state, 2.0 * 12.0 * static_cast<double>(measured.size() * corrections().size()));
  limited_by(state, assembles ? "eigen_rank_update" : state.range(0) == 1 ? "read_rows" : "read_rows_apart");
}

void round_with_weights(benchmark::State& state) { one_round(state, gonio::relative_deviation_weights{3.0}); }
BENCHMARK(round_with_weights)->Arg(1)->Arg(10)->UseRealTime()->Unit(benchmark::kMillisecond);

void round_with_automatic_weights(benchmark::State& state) { one_round(state, gonio::automatic_weights{}); }
BENCHMARK(round_with_automatic_weights)->Arg(1)->Arg(10)->UseRealTime()->Unit(benchmark::kMillisecond);

void round_with_fixed_weights(benchmark::State& state) { one_round(state, gonio::equal_weights{}); }
BENCHMARK(round_with_fixed_weights)->Arg(1)->Arg(10)->UseRealTime()->Unit(benchmark::kMillisecond);

void correction_basis(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(gonio::correction{others()});
  // The approximations of all materials by the others. Their Gram matrices are known after the first run.
  const auto k = static_cast<double>(others().size());
  count_operations(state, 6.0 * k * k * static_cast<double>(materials().cells.size()));
  limited_by(state, "eigen_product; product_into_new_memory");
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

/// The yardstick: Eigen's rank update in double, like the sums, over the same rows, in blocks that fit into the cache,
/// on two threads.
void eigen_rank_update(benchmark::State& state) {
  const auto channel = corrections().channel(1);
  const std::size_t rows = channel.values().rows();
  const Eigen::Index k = std::ssize(corrections());
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(k, k);
  for (auto _ : state) {
    const Eigen::MatrixXd sum = gonio::sum_over_blocks(rows, 256, zero, [&](Eigen::MatrixXd& part, gonio::block range) {
      const Eigen::MatrixXd block = channel.values().middleRows(range.begin, range.size()).cast<double>();
      part.selfadjointView<Eigen::Lower>().rankUpdate(block.transpose());
    });
    benchmark::DoNotOptimize(sum.data());
  }
  count_operations(state, static_cast<double>(rows) * static_cast<double>(k * (k + 1)));
}
BENCHMARK(eigen_rank_update)->UseRealTime()->Unit(benchmark::kMillisecond);

/// As many products by Eigen in float, on two threads.
void eigen_product(benchmark::State& state) {
  const auto channel = others().channel(1);
  const Eigen::Index rows = channel.values().rows(), k = std::ssize(others());
  const Eigen::MatrixXf weights = Eigen::MatrixXf::Random(channel.values().cols(), channel.values().cols());
  for (auto _ : state)
    gonio::for_each_block(rows, 256, [&](gonio::block range) {
      Eigen::MatrixXf values;
      values.noalias() = weights * channel.values().middleRows(range.begin, range.size()).transpose();
      benchmark::DoNotOptimize(values.data());
    });
  count_operations(state, 2.0 * static_cast<double>(k * k) * static_cast<double>(rows));
}
BENCHMARK(eigen_product)->UseRealTime()->Unit(benchmark::kMillisecond);

/// Eigen's products for three channels, each time into newly allocated memory, which the system clears. Corrections
/// take 1.3 GB.
void product_into_new_memory(benchmark::State& state) {
  const gonio::measured<gonio::log>& basis = others();
  const Eigen::Index cells = materials().cells.size(), k = std::ssize(basis);
  for (auto _ : state) {
    gonio::cell_matrix table(cells, 3 * k);
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto values = basis.channel(c).values();
      const Eigen::MatrixXf weights = Eigen::MatrixXf::Random(values.cols(), k);
      gonio::for_each_block(cells, 256, [&](gonio::block range) {
        table.middleRows(range.begin, range.size()).middleCols(c * k, k).noalias() =
            values.middleRows(range.begin, range.size()) * weights;
      });
    }
    benchmark::DoNotOptimize(table.data());
  }
  count_operations(state, 6.0 * static_cast<double>(k * k * cells));
}
BENCHMARK(product_into_new_memory)->UseRealTime()->Unit(benchmark::kMillisecond);

/// Reads the rows of all channels at every `step`-th cell.
void read_every(benchmark::State& state, Eigen::Index step) {
  const Eigen::Index count = materials().cells.size() / step, functions = std::ssize(corrections());
  const std::array channels{corrections().channel(0), corrections().channel(1), corrections().channel(2)};
  for (auto _ : state) {
    const float sum = gonio::sum_over_blocks(count, 1024, 0.0f, [&](float& part, gonio::block range) {
      for (Eigen::Index i = range.begin; i < range.end; ++i)
        for (const auto& channel : channels) part += channel.values().row(i * step).sum();
    });
    benchmark::DoNotOptimize(sum);
  }
  count_bytes(state, 12.0 * static_cast<double>(count * functions));
}

void read_rows(benchmark::State& state) { read_every(state, 1); }
void read_rows_apart(benchmark::State& state) { read_every(state, 10); }
BENCHMARK(read_rows_apart)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(read_rows)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
