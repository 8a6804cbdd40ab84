#include "../sampler_checks.hpp"
#include <gonio/render/environment_sampler.hpp>

#include <doctest/doctest.h>

using gonio::direction;
using gonio::render::environment_map;
using gonio::render::environment_sampler;

namespace {

const environment_sampler& lit_windows() {
  static const environment_sampler sampler(environment_map::of(gonio::render::formula_environment{}, 32));
  return sampler;
}

}  // namespace

TEST_CASE("environment sampler: what is drawn has the radiance and the density of its direction") {
  sampler_checks::uniform_numbers number(1);
  for (int i = 0; i < 2'000; ++i) {
    const double u1 = number(), u2 = number();
    const auto drawn = lit_windows().sample(u1, u2);
    CHECK(drawn.towards.norm() == doctest::Approx(1.0));
    CHECK(drawn.pdf == doctest::Approx(lit_windows().pdf(drawn.towards)).epsilon(1e-12));
    CHECK((drawn.radiance == lit_windows().map()(drawn.towards)).all());
  }
}

TEST_CASE("environment sampler: its density integrates to 1, and draws fall where it says (chi-square)") {
  const environment_map& map = lit_windows().map();
  const std::size_t pixels = map.rows() * map.columns(), draws = 100'000;
  std::vector<double> expected(pixels), found(pixels);
  double integral = 0.0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::size_t row = i / map.columns();
    expected[i] = lit_windows().pdf(map.towards(row, i % map.columns())) * map.solid_angle(row);
    integral += expected[i];
    expected[i] *= static_cast<double>(draws);
  }
  CHECK(integral == doctest::Approx(1.0));
  sampler_checks::uniform_numbers number(2);
  direction within_pixels = direction::Zero();
  for (std::size_t i = 0; i < draws; ++i) {
    const double u1 = number(), u2 = number();
    const direction d = lit_windows().sample(u1, u2).towards;
    const auto row = static_cast<std::size_t>(std::acos(d.y()) / std::numbers::pi * 32.0);
    const auto column =
        static_cast<std::size_t>((std::atan2(d.x(), -d.z()) + std::numbers::pi) / std::numbers::pi * 32.0);
    ++found[std::min<std::size_t>(row, 31) * 64 + std::min<std::size_t>(column, 63)];
    within_pixels += d - map.towards(std::min<std::size_t>(row, 31), std::min<std::size_t>(column, 63));
  }
  CHECK(sampler_checks::chi_square_p_value(expected, found) > 0.01);
  // Within a pixel of 0.1 radians all locations are equally likely. Their mean is the centre, up to 0.03 / sqrt(draws).
  CHECK((within_pixels / static_cast<double>(draws)).norm() < 5e-4);
}

TEST_CASE("environment sampler: black pixels are never drawn, not by the least and the largest numbers either") {
  gonio::image lamps = gonio::uniform_image(8, 16, gonio::rgb::Zero());
  gonio::set_pixel(lamps, 2, 5, gonio::rgb::Constant(1.0));
  gonio::set_pixel(lamps, 6, 11, gonio::rgb::Constant(1e6));
  const environment_sampler light{environment_map(lamps)};
  sampler_checks::uniform_numbers number(3);
  for (int i = 0; i < 1'000; ++i) {
    const double u1 = i == 0 ? 0.0 : i == 1 ? 1.0 - 0x1p-53 : i == 2 ? 1e-8 : number();
    const auto drawn = light.sample(u1, number());
    CHECK(drawn.pdf > 0.0);
    CHECK(drawn.towards.norm() == doctest::Approx(1.0));
  }
}
