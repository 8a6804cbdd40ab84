/// The nearest value of a MERL table at scattered pairs: gonio's look-up and that of dj_brdf (Jonathan Dupuy,
/// github.com/jdupuy/dj_brdf), which reads the file that gonio wrote.

#include "scattered_pairs.hpp"
#include <gonio/io/materials/merl.hpp>
#include <gonio/render/lookup_table.hpp>

// By default dj_brdf prints messages about directions inside the loop.
#define DJB_LOG(...)
#define DJ_BRDF_IMPLEMENTATION 1
#include <dj_brdf.h>

#include <filesystem>

namespace {

using table = gonio::render::lookup_table<float, gonio::render::interpolation::nearest>;

const table& our_table() {
  static const table ours = table::tabulated(some_material{});
  return ours;
}

const djb::merl& their_table() {
  static const djb::merl theirs =
      [] {
        const auto path = std::filesystem::temp_directory_path() / "gonio-peers.binary";
        gonio::io::write_merl(path, some_material{});
        return path.string();
      }()
          .c_str();
  return theirs;
}

void gonio_one_by_one(benchmark::State& state) {
  look_up_pairs<Eigen::Vector3f, float>(state,
                                        [](const auto& wi, const auto& wo) { return our_table()(wi, wo).sum(); });
}
BENCHMARK(gonio_one_by_one);

void gonio_many_at_once(benchmark::State& state) {
  std::array<std::vector<float>, 9> arrays;
  for (const auto& [wi, wo] : scattered_pairs())
    for (std::size_t k = 0; k < 3; ++k) {
      arrays[k].push_back(static_cast<float>(wi[static_cast<Eigen::Index>(k)]));
      arrays[3 + k].push_back(static_cast<float>(wo[static_cast<Eigen::Index>(k)]));
      arrays[6 + k].push_back(0.0f);
    }
  for (auto _ : state) {
    our_table().evaluate<float>({arrays[0], arrays[1], arrays[2]}, {arrays[3], arrays[4], arrays[5]},
                                {arrays[6], arrays[7], arrays[8]});
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(arrays[0].size()));
}
BENCHMARK(gonio_many_at_once);

void dj_brdf(benchmark::State& state) {
  look_up_pairs<djb::vec3, djb::float_t>(state, [](const auto& wi, const auto& wo) {
    const djb::vec3 value = their_table().eval(wi, wo);
    return double{value.x} + value.y + value.z;
  });
}
BENCHMARK(dj_brdf);

}  // namespace
