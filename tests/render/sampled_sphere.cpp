#include "paired_draws_sphere.hpp"
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

/// Returns the RMS difference relative to the RMS of the expected values.
double relative_error(const gonio::image& found, const gonio::image& expected) {
  REQUIRE(found.size() == expected.size());
  double squares = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    squares += std::pow(found.data()[i] - expected.data()[i], 2);
    scale += std::pow(expected.data()[i], 2);
  }
  return std::sqrt(squares / scale);
}

/// Black background, exposure 1.
template <class Sampler>
gonio::image unexposed(const Sampler& material, const gonio::render::environment_sampler& light, int size, int samples,
                       std::uint64_t seed) {
  return gonio::render::render_sphere(material, light,
                                      {.size = size,
                                       .samples = samples,
                                       .seed = seed,
                                       .white = gonio::render::white_sphere_luminance(light.map()),
                                       .shows_environment = false});
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
    INFO(name);
    CHECK(relative_error(found, expected) < 0.02);
  }
}

TEST_CASE("sampled sphere: it converges to the picture of paired draws, and faster") {
  const gonio::render::environment_sampler light(small_windows());
  const paired_draws::row_by_row_light rows(small_windows());
  for (const std::string name : {"gold-metal", "red-paint", "grey-lambertian"}) {
    const half_vector_sampler sampler(gonio::model::formula_material(name));
    const auto expected = unexposed(sampler, light, 20, 4'000, 7);
    INFO(name);
    CHECK(relative_error(paired_draws::render_sphere(sampler, rows, 20, 8'000, 1), expected) < 0.02);
    const double before = relative_error(paired_draws::render_sphere(sampler, rows, 20, 64, 1), expected);
    const double now = relative_error(unexposed(sampler, light, 20, 64, 1), expected);
    CHECK(now < 0.7 * before);
  }
}

TEST_CASE("sampled sphere: the mean of many pictures of one sample is right") {
  const gonio::render::environment_sampler light(small_windows());
  const half_vector_sampler sampler(gonio::model::formula_material("gold-metal"));
  const auto expected = unexposed(sampler, light, 12, 5'000, 7);
  gonio::image mean = gonio::uniform_image(12, 12, rgb::Zero());
  constexpr int pictures = 500;
  for (int seed = 0; seed < pictures; ++seed) mean += unexposed(sampler, light, 12, 1, 100 + seed) / float{pictures};
  CHECK(relative_error(mean, expected) < 0.08);
  // Summed over all pixels there is little noise, so a bias would show.
  double sum = 0.0, expected_sum = 0.0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    sum += mean.data()[i];
    expected_sum += expected.data()[i];
  }
  CHECK(sum == doctest::Approx(expected_sum).epsilon(0.01));
}

TEST_CASE("sampled sphere: a white Lambertian sphere has the mean luminance that is asked for") {
  CHECK(gonio::render::white_sphere_luminance(environment_map(gonio::uniform_image(64, 128, rgb::Constant(3.0)))) ==
        doctest::Approx(3.0).epsilon(1e-3));
  const gonio::render::environment_sampler light(small_windows());
  const half_vector_sampler white([](const gonio::direction& wi, const gonio::direction& wo) noexcept {
    return rgb(rgb::Constant(wi.z() > 0.0 && wo.z() > 0.0 ? std::numbers::inv_pi : 0.0));
  });
  constexpr int size = 64;
  const auto seen = gonio::render::render_sphere(
      white, light, {.size = size, .samples = 64, .white = 0.4, .shows_environment = false});
  double sum = 0.0;
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column < size; ++column) sum += gonio::luminance(gonio::pixel(seen, row, column));
  CHECK(sum / (std::numbers::pi / 4.0 * size * size) == doctest::Approx(0.4).epsilon(2e-3));
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
  CHECK(told.size() == 1u);
  CHECK(told.back() == 1.0);
  const auto darker = gonio::render::render_sphere(sampler, light, {.size = 8, .samples = 1, .white = 0.25});
  CHECK(gonio::pixel(darker, 4, 4).x() == doctest::Approx(0.25 * gonio::pixel(with, 4, 4).x()));
}
