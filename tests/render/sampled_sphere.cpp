#include <gonio/model/formula_materials.hpp>
#include <gonio/render/half_vector_sampler.hpp>
#include <gonio/render/sampled_sphere.hpp>
#include <gonio/render/sphere.hpp>

#include <doctest/doctest.h>

using gonio::rgb;
using gonio::render::environment_map;
using gonio::render::half_vector_sampler;

namespace {

const environment_map& small_windows() {
  static const environment_map map = environment_map::of(gonio::render::formula_environment{}, 64);
  return map;
}

}  // namespace

TEST_CASE("sampled sphere: it converges to the sphere under every pixel of the map") {
  const gonio::render::environment_sampler light(small_windows());
  const auto lights = all_lights(small_windows());
  for (const std::string name : {"gold-metal", "grey-lambertian"}) {
    const auto material = gonio::model::formula_material(name);
    const half_vector_sampler sampler(material);
    const auto expected = gonio::render::render_sphere(material, lights, {.size = 12, .supersampling = 6});
    const auto found = gonio::render::render_sphere(
        sampler, light, {.size = 12, .samples = 4'000, .seed = 3, .shows_environment = false});
    double squares = 0.0, scale = 0.0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      squares += std::pow(found.data()[i] - expected.data()[i], 2);
      scale += std::pow(expected.data()[i], 2);
    }
    INFO(name);
    CHECK(std::sqrt(squares / scale) < 0.02);
  }
}

TEST_CASE("sampled sphere: the same bytes for any number of threads, others for another seed") {
  const gonio::render::environment_sampler light(small_windows());
  const half_vector_sampler sampler(gonio::model::formula_material("gold-metal"));
  const auto draw = [&](std::uint64_t seed, unsigned threads) {
    return gonio::render::render_sphere(sampler, light, {.size = 9, .samples = 3, .seed = seed}, {threads});
  };
  CHECK(draw(1, 1) == draw(1, 3));
  CHECK(draw(1, 1) != draw(2, 1));
}

TEST_CASE("sampled sphere: around it is the environment, if it is to be shown") {
  const gonio::render::environment_sampler light(small_windows());
  const half_vector_sampler sampler(gonio::model::formula_material("gold-metal"));
  std::vector<double> told;
  const auto with = gonio::render::render_sphere(sampler, light, {.size = 8, .samples = 1}, {},
                                                 [&](std::string_view, double fraction) { told.push_back(fraction); });
  const auto without =
      gonio::render::render_sphere(sampler, light, {.size = 8, .samples = 1, .shows_environment = false});
  CHECK((gonio::pixel(with, 0, 0) > 0.0).all());
  CHECK((gonio::pixel(without, 0, 0) == 0.0).all());
  CHECK(told.size() == 8u);
  CHECK(told.back() == 1.0);
  const auto darker = gonio::render::render_sphere(sampler, light, {.size = 8, .samples = 1, .white = 0.25});
  CHECK(gonio::pixel(darker, 4, 4).x() == doctest::Approx(0.25 * gonio::pixel(with, 4, 4).x()));
}
