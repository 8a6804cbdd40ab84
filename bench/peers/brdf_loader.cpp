/// A measured material of the RGL database in its adaptive form, as measured (gonio's BRDF is the mean of both orders),
/// at scattered pairs, times the cosine. Compares gonio's reader with the database's own (Jonathan Dupuy and Wenzel
/// Jakob, github.com/rgl-epfl/brdf-loader) on the same file, and gonio's table of the same material.

#include "scattered_pairs.hpp"
#include <gonio/io/materials/rgl.hpp>
#include <gonio/render/lookup_table.hpp>

#define POWITACQ_IMPLEMENTATION 1
#include <powitacq_rgb.h>

namespace {

const gonio::model::adaptive_brdf& ours() {
  static const gonio::model::adaptive_brdf material = gonio::io::read_rgl(GONIO_PEERS_BSDF).material;
  return material;
}

void gonio_both_ways(benchmark::State& state) {
  look_up_pairs<gonio::direction, double>(
      state, [](const auto& wi, const auto& wo) { return (ours()(wi, wo) * wo.z()).sum(); });
}
BENCHMARK(gonio_both_ways);

void gonio_as_measured(benchmark::State& state) {
  look_up_pairs<gonio::direction, double>(
      state, [](const auto& wi, const auto& wo) { return (ours().as_measured(wi, wo) * wo.z()).sum(); });
}
BENCHMARK(gonio_as_measured);

void gonio_table(benchmark::State& state) {
  static const auto table =
      gonio::render::lookup_table<float, gonio::render::interpolation::trilinear>::tabulated(ours());
  look_up_pairs<Eigen::Vector3f, float>(state,
                                        [](const auto& wi, const auto& wo) { return (table(wi, wo) * wo.z()).sum(); });
}
BENCHMARK(gonio_table);

void brdf_loader(benchmark::State& state) {
  static const powitacq_rgb::BRDF theirs(GONIO_PEERS_BSDF);
  look_up_pairs<powitacq_rgb::Vector3f, float>(state, [](const auto& wi, const auto& wo) {
    const powitacq_rgb::Vector3f value = theirs.eval(wi, wo);
    return double{value[0]} + value[1] + value[2];
  });
}
BENCHMARK(brdf_loader);

}  // namespace
