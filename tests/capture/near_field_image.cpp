#include "lab/near_field_lab.hpp"
#include "lab/white_material.hpp"
#include <gonio/capture/near_field_image.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <variant>

using gonio::image;
using gonio::radians;
using gonio::rgb;
using gonio::capture::near_field_samples;
using gonio::capture::near_field_setup;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Light and camera at these polar angles, and the azimuth between them, in degrees. The camera looks at the middle of
/// a disc that spans 25 degrees from distance 1, with 60 x 80 pixels.
near_field_setup setup_at(double light, double camera, double azimuth) {
  const double radius = std::tan(radians(12.5));
  const gonio::camera_intrinsics intrinsics{60, 80, 120.0, 125.0, 41.0, 29.0};
  const Eigen::Vector3d position = gonio::spherical_direction(radians(camera), 0.3);
  return {.camera = gonio::pinhole_camera::look_at(intrinsics, position, {0.0, 0.0, 0.0}, {-0.2, 0.1, 1.0}),
          .light = gonio::directional_light{gonio::spherical_direction(radians(light), 0.3 + radians(azimuth)),
                                            {2.0, 1.0, 0.5}},
          .disc = gonio::capture::sample_disc{radius}};
}

/// A set-up with moderate angles, for tests that do not depend on the directions.
near_field_setup ordinary_setup() { return setup_at(50.0, 40.0, 180.0); }

/// Returns the distant light of a set-up.
auto& light_of(auto& setup) { return std::get<gonio::directional_light>(setup.light); }

const gonio::model::formula_brdf paint = gonio::model::formula_material("red-paint");

rgb truth_at(const gonio::half_difference& angles) {
  const auto [wi, wo] = gonio::to_directions(angles);
  return paint(wi, wo);
}

/// Returns the largest relative error of the samples.
double largest_error(const gonio::sample_set& samples) {
  double largest = 0.0;
  for (const gonio::sample& s : samples)
    largest = std::max(largest, (s.value / truth_at(s.angles()) - 1.0).abs().maxCoeff());
  return largest;
}

double root_mean_square_error(const gonio::sample_set& samples) {
  double sum = 0.0;
  for (const gonio::sample& s : samples) sum += (s.value / truth_at(s.angles()) - 1.0).square().sum();
  return std::sqrt(sum / (3.0 * static_cast<double>(samples.size())));
}

}  // namespace

TEST_CASE("without noise the paint's values come back, whatever the pose") {
  CHECK(rc::check([] {
    const auto setup = setup_at(*rc::gen::inRange(0, 86), *rc::gen::inRange(0, 76), *rc::gen::inRange(-180, 181));
    const auto samples = near_field_samples(lab::photograph(paint, *setup.disc, setup), setup);
    RC_ASSERT_FALSE(samples.empty());
    RC_ASSERT(largest_error(samples) < 1e-6);  // pixels are floats
    RC_ASSERT(std::ranges::all_of(samples, [](const auto& s) { return s.weight == 1.0; }));
  }));
}

TEST_CASE("samples are the disc's pixels in their order, with the light that was given") {
  const auto setup = ordinary_setup();
  const auto samples = near_field_samples(lab::photograph(paint, *setup.disc, setup), setup);
  gonio::require_usable(samples);
  std::size_t next = 0;
  for (std::size_t row = 0; row < 60; ++row)
    for (std::size_t column = 0; column < 80; ++column) {
      const auto line = setup.camera.ray_through(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
      const auto point = line.at_ground();
      if (!point || point->norm() > setup.disc->radius) continue;
      REQUIRE(next < samples.size());
      const auto& angles = samples[next++].angles();
      const auto expected = gonio::to_half_difference(light_of(setup).towards, -line.towards);
      REQUIRE(angles.theta_h == doctest::Approx(expected.theta_h));
      REQUIRE(angles.theta_d == doctest::Approx(expected.theta_d));
      REQUIRE(angles.phi_d == doctest::Approx(expected.phi_d));
    }
  CHECK(next == samples.size());
  // The pixels that the ellipse of the disc covers: 120 x 125 tan(12.5) tan(12.5) cos(40) pi.
  CHECK(static_cast<double>(next) == doctest::Approx(1774.0).epsilon(0.06));
}

TEST_CASE("a grey Lambertian of albedo 0.5 under irradiance 2 has radiance 2 cos / (2 pi)") {
  auto setup = setup_at(60.0, 0.0, 0.0);
  light_of(setup).irradiance = rgb::Constant(2.0);
  const image picture = gonio::uniform_image(60, 80, rgb::Constant(0.5 / std::numbers::pi));
  for (const gonio::sample& s : near_field_samples(picture, setup))
    for (const double channel : s.value) REQUIRE(channel == doctest::Approx(0.5 / std::numbers::pi));
}

TEST_CASE("the region is the disc, the window, or both") {
  auto setup = ordinary_setup();
  const image picture = lab::photograph(paint, {.radius = 3.0}, setup);
  const std::size_t disc = near_field_samples(picture, setup).size();
  setup.window = gonio::capture::pixel_window{30, 20, 7, 5};
  CHECK(near_field_samples(picture, setup).size() == 35);
  setup.disc = {};
  CHECK(near_field_samples(picture, setup).size() == 35);
  setup.window = {};
  CHECK(near_field_samples(picture, setup).size() == 60 * 80);
  setup.disc = gonio::capture::sample_disc{.radius = std::tan(radians(12.5)), .centre = {0.02, 0.0}};
  const std::size_t beside = near_field_samples(picture, setup).size();
  CHECK(beside != disc);
  CHECK(static_cast<double>(beside) == doctest::Approx(static_cast<double>(disc)).epsilon(0.05));
}

TEST_CASE("a mask excludes pixels, and the region's pixels are those with samples") {
  auto setup = ordinary_setup();
  const image picture = lab::photograph(paint, *setup.disc, setup);
  const auto region = gonio::capture::pixels_of_region(setup);
  const auto all = near_field_samples(picture, setup);
  REQUIRE(region.size() == all.size());
  setup.mask.assign(60 * 80, false);
  for (std::size_t i = 0; i < region.size(); i += 2) setup.mask[region[i]] = true;
  const auto half = near_field_samples(picture, setup);
  REQUIRE(half.size() == (all.size() + 1) / 2);
  for (std::size_t i = 0; i < half.size(); ++i) CHECK(half[i].angles().theta_h == all[2 * i].angles().theta_h);
  CHECK(gonio::capture::pixels_of_region(setup).size() == half.size());
  setup.mask.pop_back();
  CHECK_THROWS_WITH_AS(static_cast<void>(near_field_samples(picture, setup)), doctest::Contains("mask"), gonio::error);
}

TEST_CASE("a sample's cones are the light's, and a receiver's that blurs half vectors as its block does") {
  // Light and camera directly above: half vectors turn by half the angle by which the view turns.
  constexpr double focal_length = 2000.0;
  const gonio::lens_camera camera(gonio::pinhole_camera::look_at({100, 100, focal_length, focal_length, 50.0, 50.0},
                                                                 {0.0, 0.0, 8.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}));
  gonio::capture::near_field_setup setup{.camera = camera,
                                         .light = gonio::directional_light{{0.0, 0.0, 1.0}, rgb::Ones(), 0.02},
                                         .disc = gonio::capture::sample_disc{0.1}};
  for (const std::size_t block : {1, 10}) {
    setup.block = block;
    const auto samples = near_field_samples(lab::photograph(paint, *setup.disc, setup), setup);
    const double expected = static_cast<double>(block) / focal_length / std::sqrt(3.0);
    for (const gonio::sample& s : samples) {
      CHECK(s.aperture.source == 0.02);
      CHECK(s.aperture.receiver == doctest::Approx(expected).epsilon(0.01));
    }
  }
  // A lamp as far away as the camera: the half vectors turn by the same angle as the view.
  setup.light = gonio::capture::point_lamp{{0.0, 0.0, 8.0}, rgb::Ones(), 0.4};
  const auto samples = near_field_samples(lab::photograph(paint, *setup.disc, setup), setup);
  CHECK(samples[0].aperture.receiver == doctest::Approx(2.0 * 10.0 / focal_length / std::sqrt(3.0)).epsilon(0.01));
  CHECK(samples[0].aperture.source == doctest::Approx(0.05).epsilon(0.01));
}

TEST_CASE("blocks average their pixels, and their weight is the fraction of used pixels") {
  auto setup = ordinary_setup();
  const image picture = lab::photograph(paint, *setup.disc, setup);
  const auto pixels = near_field_samples(picture, setup);
  setup.block = 7;  // does not divide the image size
  const auto blocks = near_field_samples(picture, setup);
  CHECK(blocks.size() < pixels.size() / 30);
  rgb sum_of_pixels = rgb::Zero(), sum_of_blocks = rgb::Zero();
  double weights = 0.0;
  for (const gonio::sample& s : pixels) sum_of_pixels += s.value;
  for (const gonio::sample& s : blocks) {
    CHECK(s.weight.is_uniform());
    CHECK(s.weight.counts());
    CHECK(s.weight.mean() <= 1.0);
    sum_of_blocks += 49.0 * s.weight.of_each() * s.value;
    weights += 49.0 * s.weight.mean();
  }
  CHECK(weights == doctest::Approx(static_cast<double>(pixels.size())));
  CHECK((sum_of_blocks / sum_of_pixels - 1.0).abs().maxCoeff() < 1e-6);
  // The BRDF is not linear within a block of 3 degrees, least of all in the highlight.
  CHECK(root_mean_square_error(blocks) < 0.006);  // measured: 0.0041
}

TEST_CASE("noise is as large as the pixels', smaller for blocks, and depends on the seed alone") {
  auto setup = ordinary_setup();
  const lab::near_field_defects noisy{.noise = 0.05};
  const image picture = lab::photograph(paint, *setup.disc, setup, noisy, 7);
  CHECK(root_mean_square_error(near_field_samples(picture, setup)) == doctest::Approx(0.05).epsilon(0.05));
  CHECK(picture == lab::photograph(paint, *setup.disc, setup, noisy, 7));
  CHECK(picture != lab::photograph(paint, *setup.disc, setup, noisy, 8));
  setup.block = 3;
  CHECK(root_mean_square_error(near_field_samples(picture, setup)) < 0.02);  // measured: 0.0171
}

TEST_CASE("the error from a slight misalignment of light and camera is bounded") {
  const auto setup = ordinary_setup();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    const lab::near_field_defects shifted{.misalignment = radians(1.0)};
    // With shifted angles, the rim may leave the assumed disc, so the material is made larger.
    const image picture = lab::photograph(paint, {.radius = 0.4}, setup, shifted, seed);
    CHECK(root_mean_square_error(near_field_samples(picture, setup)) < 0.2);  // measured: up to 0.135
    // For a Lambertian only the light's cosine matters: cos(theta + 1 degree) / cos(theta).
    const gonio::model::lambertian grey{rgb::Constant(0.18)};
    const double bound = std::tan(radians(50.0)) * radians(1.0) * 1.02;
    for (const gonio::sample& s :
         near_field_samples(lab::photograph(grey, {.radius = 0.4}, setup, shifted, seed), setup))
      REQUIRE((s.value * std::numbers::pi / 0.18 - 1.0).abs().maxCoeff() < bound);
  }
}

TEST_CASE("saturated pixels are skipped with their blocks, and infinite ones if they are saturated") {
  auto setup = ordinary_setup();
  image picture = lab::photograph(paint, *setup.disc, setup);
  const std::size_t all = near_field_samples(picture, setup).size();
  gonio::set_pixel(picture, 29, 41, {0.1, 0.9, 0.1});
  gonio::set_pixel(picture, 29, 42, {0.1, 0.1, infinity});
  setup.saturation = 0.9;  // larger than the value in the image, 0.9f
  const auto is_saturated = [&](std::size_t row, std::size_t column) -> std::size_t {
    return (gonio::pixel(picture, row, column) > 0.8999999).any() ? 1 : 0;
  };
  std::size_t saturated = 0;
  for (std::size_t row = 0; row < 60; ++row)
    for (std::size_t column = 0; column < 80; ++column) saturated += is_saturated(row, column);
  CHECK(saturated >= 2);
  CHECK(saturated < all / 10);
  CHECK(near_field_samples(picture, setup).size() == all - saturated);
  // A block of three by three with a saturated middle pixel gives no sample.
  setup.window = gonio::capture::pixel_window{40, 28, 3, 3};
  CHECK(near_field_samples(picture, setup).size() < 9);
  setup.block = 3;
  CHECK_THROWS_AS(near_field_samples(picture, setup), gonio::error);
  setup.block = 60;
  setup.window = gonio::capture::pixel_window{10, 0, 60, 60};
  CHECK_THROWS_WITH_AS(near_field_samples(picture, setup), doctest::Contains("saturated"), gonio::error);
}

TEST_CASE("pixels that are not finite are refused by row and column if they see the region; negative ones are kept") {
  const auto setup = ordinary_setup();
  const auto image_with = [&](std::size_t row, std::size_t column, double value) {
    image picture = lab::photograph(paint, *setup.disc, setup);
    gonio::set_pixel(picture, row, column, {0.1, value, 0.1});
    return picture;
  };
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
    CHECK_THROWS_WITH_AS(near_field_samples(image_with(28, 40, bad), setup),
                         doctest::Contains("pixel (row 28, column 40) is not finite"), gonio::error);
    CHECK_NOTHROW(near_field_samples(image_with(0, 0, bad), setup));
  }
  const auto samples = near_field_samples(image_with(28, 40, -0.01), setup);
  CHECK(std::ranges::count_if(samples, [](const auto& s) { return s.value.y() < 0.0; }) == 1);
}

TEST_CASE("set-ups that cannot be measured are refused") {
  const auto refused = [](const std::function<void(near_field_setup&)>& change, const char* why) {
    near_field_setup setup = ordinary_setup();
    const image picture = lab::photograph(paint, *setup.disc, setup);
    change(setup);
    CHECK_THROWS_WITH_AS(near_field_samples(picture, setup), doctest::Contains(why), gonio::error);
  };
  const auto camera_from = [](const Eigen::Vector3d& position, const Eigen::Vector3d& target) {
    return gonio::pinhole_camera::look_at(ordinary_setup().camera.intrinsics(), position, target, {0.0, 1.0, 0.1});
  };
  refused([&](auto& s) { s.camera = camera_from({0.0, 0.5, -1.0}, {0.0, 0.0, 0.0}); }, "camera is not above");
  refused([&](auto& s) { s.camera = camera_from({0.0, 0.5, 0.0}, {0.0, 0.0, 0.0}); }, "camera is not above");
  refused([&](auto& s) { s.camera = camera_from({0.0, 0.5, 1.0}, {0.0, 0.0, 3.0}); }, "does not show the sample");
  refused([&](auto& s) { s.camera = camera_from({0.0, 0.5, 1.0}, {9.0, 0.0, 0.0}); }, "does not show the sample");
  refused([](auto& s) { light_of(s).towards = {0.0, 1.0, 0.0}; }, "light is at or below the sample's horizon");
  refused([](auto& s) { light_of(s).towards = {0.0, 0.0, 2.0}; }, "length 1");
  refused([](auto& s) { light_of(s).towards.x() = infinity; }, "length 1");
  refused([](auto& s) { light_of(s).irradiance = {1.0, 0.0, 1.0}; }, "irradiance");
  refused([](auto& s) { light_of(s).irradiance = {1.0, infinity, 1.0}; }, "irradiance");
  refused([](auto& s) { s.disc->radius = 0.0; }, "positive radius");
  refused([](auto& s) { s.disc->centre.x() = infinity; }, "finite centre");
  refused([](auto& s) { s.window = gonio::capture::pixel_window{0, 0, 0, 5}; }, "window");
  refused([](auto& s) { s.window = gonio::capture::pixel_window{79, 0, 2, 5}; }, "80 x 60");
  refused([](auto& s) { s.window = gonio::capture::pixel_window{0, 60, 2, 1}; }, "80 x 60");
  refused([](auto& s) { s.saturation = 0.0; }, "saturation must be positive");
  refused([](auto& s) { s.saturation = 1e-9; }, "is saturated");
  refused([](auto& s) { s.block = 0; }, "block");
  refused([](auto& s) { s.light = gonio::capture::point_lamp{{0.0, 0.0, -1.0}}; }, "at or below the sample's horizon");
  const auto setup = ordinary_setup();
  CHECK_THROWS_WITH_AS(near_field_samples(gonio::uniform_image(80, 60), setup),
                       doctest::Contains("the image has 60 x 80 pixels, but its camera 80 x 60"), gonio::error);
  CHECK_THROWS_WITH_AS(near_field_samples(image({60, 80, 4}, 0.0f), setup), doctest::Contains("4 channels"),
                       gonio::error);
}

// ---- lens, lamp and white image ---------------------------------------------------------------

namespace {

/// A lens with distortion, and a lamp at a finite distance.
near_field_setup lamp_setup() {
  near_field_setup setup = ordinary_setup();
  const gonio::direction light = light_of(setup).towards;
  setup.light = gonio::capture::point_lamp{4.0 * light, {32.0, 16.0, 8.0}};
  setup.camera = gonio::lens_camera(setup.camera.pinhole(), {.k1 = -0.2, .k2 = 0.05, .p1 = 0.002, .p2 = -0.001});
  return setup;
}

/// An image that darkens towards the right.
image vignetted(image picture) {
  for (std::size_t row = 0; row < picture.shape(0); ++row)
    for (std::size_t column = 0; column < picture.shape(1); ++column)
      gonio::set_pixel(picture, row, column,
                       gonio::pixel(picture, row, column) * (1.0 - 0.005 * static_cast<double>(column)));
  return picture;
}

}  // namespace

TEST_CASE("the paint's values come back through a lens that distorts, under a lamp at a finite distance") {
  const auto setup = lamp_setup();
  const auto samples = near_field_samples(lab::photograph(paint, {.radius = 0.5}, setup), setup);
  CHECK(largest_error(samples) < 1e-6);
  // Each pixel has its own direction of the light.
  CHECK((samples.front().directions.pair().wi - samples.back().directions.pair().wi).norm() > 0.05);
  // A pinhole at the same position would assign other directions.
  near_field_setup straight = setup;
  straight.camera = setup.camera.pinhole();
  CHECK(largest_error(near_field_samples(lab::photograph(paint, {.radius = 0.5}, setup), straight)) > 0.001);
}

TEST_CASE("a white image removes vignetting, the lamp's intensity and its falloff") {
  const auto setup = lamp_setup();
  const image picture = vignetted(lab::photograph(paint, {.radius = 0.5}, setup));
  gonio::capture::white_reference white{
      vignetted(lab::photograph(lab::white_material{0.9}, {.radius = 0.5}, setup)), 0.9, {}};
  CHECK(largest_error(near_field_samples(picture, setup)) > 0.1);
  near_field_setup unknown = setup;
  std::get<gonio::capture::point_lamp>(unknown.light).intensity = rgb::Ones();
  CHECK(largest_error(near_field_samples(picture, unknown, white)) < 1e-5);
  unknown.block = 3;
  CHECK(near_field_samples(picture, unknown, white).size() < 300);
  unknown.block = 1;

  const std::size_t all = near_field_samples(picture, unknown, white).size();
  gonio::set_pixel(white.photograph, 28, 40, {0.1, 0.0, 0.1});  // a dark pixel of the white image gives no value
  CHECK(near_field_samples(picture, unknown, white).size() == all - 1);
  const auto values = gonio::capture::region_reflectance(picture, unknown, white);
  CHECK(values.size() == all);
  CHECK(std::ranges::count_if(values, [](const rgb& value) { return (value == 0.0).all(); }) == 1);
  gonio::set_pixel(white.photograph, 28, 40, {0.1, std::numeric_limits<double>::quiet_NaN(), 0.1});
  CHECK_THROWS_WITH_AS(near_field_samples(picture, unknown, white),
                       doctest::Contains("the white image: pixel (row 28, column 40) is not finite"), gonio::error);
  unknown.saturation = 0.9;
  gonio::set_pixel(white.photograph, 28, 40, {0.1, infinity, 0.1});
  CHECK(near_field_samples(picture, unknown, white).size() < all);
  white.photograph = gonio::uniform_image(3, 3);
  CHECK_THROWS_WITH_AS(near_field_samples(picture, setup, white), doctest::Contains("the white image has 3 x 3"),
                       gonio::error);
}

TEST_CASE("a white board above the sample is divided by its own cosine and distance") {
  const auto setup = lamp_setup();
  const gonio::capture::placed_plane board{{0.0, 0.0, 0.05}, {0.1, 0.0, 1.0}};
  gonio::capture::white_reference white{gonio::uniform_image(60, 80), 0.9,
                                        gonio::capture::surface_of(board, setup.camera)};
  for (std::size_t row = 0; row < 60; ++row)
    for (std::size_t column = 0; column < 80; ++column) {
      const Eigen::Index number = white.surface->pixel(row, column);
      if (!white.surface->sees(number)) continue;
      const auto lit = gonio::capture::light_at(setup.light, white.surface->positions.col(number));
      const double cosine = lit.towards.dot(white.surface->normals.col(number));
      gonio::set_pixel(white.photograph, row, column, lit.irradiance * cosine * 0.9 / std::numbers::pi);
    }
  CHECK(largest_error(near_field_samples(lab::photograph(paint, {.radius = 0.5}, setup), setup, white)) < 1e-5);
}
