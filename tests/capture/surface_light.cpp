#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/surface_light.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <numbers>

using gonio::rgb;
using gonio::capture::illumination;
using gonio::capture::point_lamp;
using gonio::capture::white_reference;

namespace {

/// A camera that looks down on the plane z = 0 from a height of 1.
gonio::lens_camera overhead_camera() {
  return gonio::pinhole_camera::look_at(gonio::camera_intrinsics::square(5, 0.5), {0.0, 0.0, 1.0}, {0.0, 0.0, 0.0},
                                        {0.0, 1.0, 0.0});
}

}  // namespace

TEST_CASE("a lamp's light falls off with the square of its distance, a distant light does not") {
  const point_lamp lamp{{0.0, 0.0, 2.0}, rgb(8.0, 4.0, 2.0)};
  const auto below = gonio::capture::light_at(lamp, {0.0, 0.0, 0.0});
  CHECK(below.towards == gonio::direction(0.0, 0.0, 1.0));
  CHECK((below.irradiance == rgb(2.0, 1.0, 0.5)).all());
  CHECK(below.distance == 2.0);
  const gonio::directional_light distant{{0.0, 0.6, 0.8}, rgb(3.0, 2.0, 1.0)};
  for (const double x : {0.0, 100.0}) {
    const auto lit = gonio::capture::light_at(distant, {x, 0.0, 0.0});
    CHECK(lit.towards == distant.towards);
    CHECK((lit.irradiance == distant.irradiance).all());
  }
}

TEST_CASE("a white reference at the surface has the surface's light, a board elsewhere its own") {
  const gonio::lens_camera camera = overhead_camera();
  const point_lamp lamp{{0.0, 0.0, 3.0}};
  const illumination here{0.8, 3.0};
  white_reference white{gonio::uniform_image(5, 5, rgb::Ones()), 0.9, {}};
  const auto in_place = gonio::capture::white_illumination(white, lamp, 2, 2, here, 0.0);
  REQUIRE(in_place);
  CHECK(in_place->cosine == 0.8);
  CHECK(in_place->distance == 3.0);
  white.surface = gonio::capture::surface_of(gonio::capture::placed_plane{{0.0, 0.0, 0.5}, {0.0, 0.0, 1.0}}, camera);
  const auto board = gonio::capture::white_illumination(white, lamp, 2, 2, here, 0.0);
  REQUIRE(board);
  CHECK(board->cosine == doctest::Approx(1.0));
  CHECK(board->distance == doctest::Approx(2.5));
  // A lamp below does not light the board. A board that faces away is not visible.
  CHECK_FALSE(gonio::capture::white_illumination(white, point_lamp{{0.0, 0.0, -1.0}}, 2, 2, here, 0.0));
  white.surface = gonio::capture::surface_of(gonio::capture::placed_plane{{0.0, 0.0, 0.5}, {0.0, 0.0, -1.0}}, camera);
  CHECK_FALSE(gonio::capture::white_illumination(white, lamp, 2, 2, here, 0.0));
}

TEST_CASE("equal radiance gives the reference's reflectance / pi; half the light gives twice the BRDF") {
  const rgb same =
      gonio::capture::relative_to_white(rgb(3.0, 2.0, 1.0), {0.5, 2.0}, rgb(3.0, 2.0, 1.0), 0.9, {0.5, 2.0});
  CHECK((same * std::numbers::pi / 0.9 - 1.0).abs().maxCoeff() < 1e-12);
  const rgb dimmer = gonio::capture::relative_to_white(rgb::Ones(), {0.25, 2.0}, rgb::Ones(), 0.9, {0.5, 2.0});
  CHECK((dimmer * std::numbers::pi / 0.9 - 2.0).abs().maxCoeff() < 1e-12);
  const rgb farther = gonio::capture::relative_to_white(rgb::Ones(), {0.5, 4.0}, rgb::Ones(), 0.9, {0.5, 2.0});
  CHECK((farther * std::numbers::pi / 0.9 - 4.0).abs().maxCoeff() < 1e-12);
  // The merged value of a black pixel may be negative.
  CHECK((gonio::capture::relative_to_white(rgb::Constant(-0.01), {}, rgb::Ones(), 1.0, {}) < 0.0).all());
}

TEST_CASE("impossible lights and white references are refused") {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const auto refuses = [](const gonio::capture::surface_light& light, const char* why) {
    CHECK_THROWS_WITH_AS(gonio::capture::require_usable(light), doctest::Contains(why), gonio::error);
  };
  refuses(gonio::directional_light{{0.0, 0.0, 2.0}}, "length 1");
  refuses(gonio::directional_light{{0.0, 0.0, 1.0}, rgb(1.0, 0.0, 1.0)}, "irradiance");
  refuses(point_lamp{{0.0, infinite, 1.0}}, "position must be finite");
  refuses(point_lamp{{0.0, 0.0, 1.0}, rgb(1.0, -1.0, 1.0)}, "intensity");
  const auto refuses_white = [](const white_reference& white, const char* why) {
    CHECK_THROWS_WITH_AS(gonio::capture::require_usable(white, overhead_camera().intrinsics()), doctest::Contains(why),
                         gonio::error);
  };
  refuses_white({gonio::uniform_image(5, 4), 0.9, {}}, "the white image has 4 x 5 pixels, but its camera 5 x 5");
  refuses_white({gonio::image({5, 5, 1}, 0.0f), 0.9, {}}, "1 channels");
  refuses_white({gonio::uniform_image(5, 5), 0.0, {}}, "above 0 and up to 1");
  refuses_white({gonio::uniform_image(5, 5), 1.1, {}}, "above 0 and up to 1");
  refuses_white({gonio::uniform_image(5, 5), 0.9, gonio::surface_image::nothing(2, 5)},
                "the white reference's surface");
}
