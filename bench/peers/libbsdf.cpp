/// A GGX lobe fitted to samples of a measured material, by gonio and by libbsdf (Kimura Ryo,
/// github.com/KimuraRyo/libbsdf), which uses Ceres. libbsdf draws as many directions from the table that it reads, and
/// fits a colour and a roughness to logarithms. gonio fits colour, roughness and reflectance at normal incidence. Then
/// interpolates the table at scattered pairs.

#include "scattered_pairs.hpp"
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/model/fit_model.hpp>
#include <gonio/render/lookup_table.hpp>
#include <gonio/table/brdf_table.hpp>

#include <libbsdf/Brdf/HalfDifferenceCoordinatesBrdf.h>
#include <libbsdf/Fitter/SimpleGgxFitter.h>
#include <libbsdf/Reader/MerlBinaryReader.h>

#include <filesystem>
#include <memory>

namespace {

const gonio::brdf_table& measured() {
  static const gonio::brdf_table table =
      gonio::tabulate(gonio::io::read_rgl(GONIO_PEERS_BSDF).material, gonio::valid_cells());
  return table;
}

const lb::Brdf& their_table() {
  static const std::unique_ptr<lb::Brdf> table([] {
    const auto path = std::filesystem::temp_directory_path() / "gonio-peers.binary";
    gonio::io::write_merl(path, measured());
    return lb::MerlBinaryReader::read(path.string());
  }());
  return *table;
}

void gonio_fit(benchmark::State& state) {
  const auto& cells = measured().cells();
  const auto samples = gonio::sample_table(measured(), gonio::random_cells(cells, state.range(0), 1));
  const auto observations = gonio::model::fit_observations(samples);
  const std::vector<const gonio::model::lobe_kind*> kinds{&gonio::model::lobe_kind_named("ggx")};
  for (auto _ : state) benchmark::DoNotOptimize(gonio::model::fit_model(kinds, observations, gonio::log()).loss);
}
BENCHMARK(gonio_fit)->Arg(10'000)->UseRealTime()->Unit(benchmark::kMillisecond);

void libbsdf_fit(benchmark::State& state) {
  static_cast<void>(their_table());
  for (auto _ : state)
    benchmark::DoNotOptimize(lb::SimpleGgxFitter::estimateParameters(their_table(), static_cast<int>(state.range(0)))
                                 .getParameters()
                                 .size());
}
BENCHMARK(libbsdf_fit)->Arg(10'000)->UseRealTime()->Unit(benchmark::kMillisecond);

void gonio_trilinear(benchmark::State& state) {
  using gonio::render::interpolation;
  static const auto table = gonio::render::lookup_table<float, interpolation::trilinear>::tabulated(measured());
  look_up_pairs<Eigen::Vector3f, float>(state, [](const auto& wi, const auto& wo) { return table(wi, wo).sum(); });
}
BENCHMARK(gonio_trilinear);

void libbsdf_interpolated(benchmark::State& state) {
  look_up_pairs<lb::Vec3, double>(state, [](const auto& wi, const auto& wo) {
    return static_cast<double>(their_table().getSpectrum(wi, wo).sum());
  });
}
BENCHMARK(libbsdf_interpolated);

}  // namespace
