/// The cost of learning a shape model and recovering a scan on one core, at the published size: 161 synthetic ear
/// canals of 3,096 vertices.

#include "../synthetic/ear_canal_scans.hpp"
#include <gonio/shape/recovery.hpp>
#include <gonio/shape/shape_context_alignment.hpp>

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace {

constexpr gonio::thread_count one{1};

struct ears {
  synthetic::ear_canal_family family;
  synthetic::ear_canal_template common;
  std::vector<gonio::shape::point_columns> shapes;
  std::vector<std::string> names;

  explicit ears(std::size_t count = 161) {
    for (std::size_t i = 0; i < count; ++i) {
      shapes.push_back(common.corresponded(family.draw(i)));
      names.push_back("ear-" + std::to_string(i));
    }
  }

  [[nodiscard]] gonio::shape::shape_model learn() const {
    return gonio::shape::learn_shape_model(shapes, names, common.mesh().triangles, one);
  }
  [[nodiscard]] synthetic::ear_scan scan() const {
    synthetic::scan_options how;
    how.hole = synthetic::hole_options::large();
    how.complete_vertices = 0;
    return synthetic::scan_of(family.draw(5000), common, 1, how);
  }
};

const ears& published() {
  static const ears all;
  return all;
}

const gonio::shape::shape_model& model() {
  static const gonio::shape::shape_model learned = published().learn();
  return learned;
}

void learn(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(published().learn());
}

void find_pose(benchmark::State& state) {
  const synthetic::ear_scan scan = published().scan();
  const gonio::shape::shape_context_matcher matcher(model().mean(), {}, one);
  for (auto _ : state) benchmark::DoNotOptimize(matcher.align(scan.mesh, one));
}

void index_scan(benchmark::State& state) {
  const synthetic::ear_scan scan = published().scan();
  for (auto _ : state) benchmark::DoNotOptimize(gonio::shape::surface_index(scan.mesh));
}

void recover(benchmark::State& state) {
  const synthetic::ear_scan scan = published().scan();
  const gonio::shape::surface_index index(scan.mesh);
  const auto pose = gonio::shape::align(scan.truth, model().mean().vertices);
  for (auto _ : state) benchmark::DoNotOptimize(gonio::shape::recover(model(), index, pose, {}, one));
}

void recover_algorithm_1(benchmark::State& state) {
  const synthetic::ear_scan scan = published().scan();
  const gonio::shape::surface_index index(scan.mesh);
  const auto pose = gonio::shape::align(scan.truth, model().mean().vertices);
  for (auto _ : state) benchmark::DoNotOptimize(gonio::shape::recover_algorithm_1(model(), index, pose, {}, one));
}

BENCHMARK(learn)->Unit(benchmark::kMillisecond);
BENCHMARK(find_pose)->Unit(benchmark::kMillisecond);
BENCHMARK(index_scan)->Unit(benchmark::kMillisecond);
BENCHMARK(recover)->Unit(benchmark::kMillisecond);
BENCHMARK(recover_algorithm_1)->Unit(benchmark::kMillisecond);

}  // namespace
