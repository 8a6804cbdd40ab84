/// Fits of a Torrance-Sparrow lobe plus a Lambertian lobe to one RGB table over all cells of MERL's grid: the time of a
/// fit, the speed of a pass over the cells, and the cost of random starts in addition to the consecutive scheme, which
/// ends at the same loss.

#include "../real_materials.hpp"
#include <gonio/model/fit_model.hpp>

#include <benchmark/benchmark.h>

namespace {

const std::vector<gonio::model::fit_observation>& observations() {
  static const auto all = [] {
    const gonio::material_set materials = real_materials();
    const auto nickel = std::ranges::find(materials.names, "nickel") - materials.names.begin();
    return gonio::model::fit_observations(materials.table(nickel));
  }();
  return all;
}

const std::vector<const gonio::model::lobe_kind*>& kinds() {
  static const std::vector all{&gonio::model::lobe_kind::of<gonio::model::lambert_shape>(),
                               &gonio::model::lobe_kind::of<gonio::model::torrance_sparrow_shape>()};
  return all;
}

/// Fits with `state.range(0)` random starts in addition to the consecutive one, in `state.range(1)` threads.
void fit_table(benchmark::State& state) {
  const gonio::model::model_fit_options options{.random_starts = state.range(0),
                                                .threads = {static_cast<unsigned>(state.range(1))}};
  static_cast<void>(observations());
  gonio::model::model_fit fit;
  for (auto _ : state) fit = gonio::model::fit_model(kinds(), observations(), gonio::lin(), options);
  state.counters["loss"] = fit.loss;
  state.counters["evaluations"] = static_cast<double>(fit.evaluations);
  state.counters["fits/s"] = benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["Mcells/s"] = benchmark::Counter(1e-6 * static_cast<double>(observations().size() * fit.evaluations),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(fit_table)->Args({0, 1})->Args({0, 2})->Args({5, 2})->UseRealTime()->Unit(benchmark::kSecond)->Iterations(1);

void fit_table_by_l1(benchmark::State& state) {
  const gonio::model::model_fit_options options{.norm = gonio::model::fit_norm::l1, .threads = {2}};
  static_cast<void>(observations());
  for (auto _ : state)
    benchmark::DoNotOptimize(gonio::model::fit_model(kinds(), observations(), gonio::lin(), options).loss);
  state.counters["fits/s"] = benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(fit_table_by_l1)->UseRealTime()->Unit(benchmark::kSecond)->Iterations(1);

/// A typical laboratory fit: 20 samples.
void fit_20_samples(benchmark::State& state) {
  std::vector<gonio::model::fit_observation> few;
  for (std::size_t i = 0; i < 20; ++i) few.push_back(observations()[i * i * 2711 % observations().size()]);
  for (auto _ : state) benchmark::DoNotOptimize(gonio::model::fit_model(kinds(), few).loss);
}
BENCHMARK(fit_20_samples)->Unit(benchmark::kMicrosecond);

}  // namespace
