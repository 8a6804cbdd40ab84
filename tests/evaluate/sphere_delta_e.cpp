#include <gonio/evaluate/sphere_delta_e.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/render/environment_map.hpp>

#include <doctest/doctest.h>

#include <cmath>

using gonio::brdf_table;
using gonio::rgb;
using gonio::sphere_delta_e;
using gonio::render::environment_map;

namespace {

const gonio::valid_cells& room_cells() {
  static const gonio::valid_cells cells(gonio::grid({20, 15, 30}));
  return cells;
}

environment_map room() { return environment_map::of(gonio::render::formula_environment{}, 32); }

/// Colour differences under the closed-form environment.
const sphere_delta_e& room_delta_e() {
  static const sphere_delta_e delta_e(room_cells(), gonio::render::important_lights(room(), 200, 1), 12);
  return delta_e;
}

brdf_table matte(const rgb& albedo) { return gonio::tabulate(gonio::model::lambertian{albedo}, room_cells()); }

brdf_table formula(const char* name) { return gonio::tabulate(gonio::model::formula_material(name), room_cells()); }

double mean_luminance(const gonio::render::sphere_colours& colours) {
  double sum = 0.0;
  for (Eigen::Index point = 0; point < colours.rows(); ++point) sum += gonio::luminance(colours.row(point).transpose());
  return sum / static_cast<double>(colours.rows());
}

gonio::render::directional_lighting headlight() { return gonio::render::directional_lighting({{{0.0, 0.0, 1.0}}}); }

/// The same irradiance at every point, so a matte sphere has the same colour everywhere.
struct flat_light {
  template <class Visit>
  void for_each_incident(const gonio::direction& normal, Visit&& visit) const {
    const gonio::direction wo = gonio::render::surface_frame(normal).to_local(gonio::direction::UnitZ());
    if (wo.z() > 0.0) visit(wo, wo, rgb(rgb::Ones()));
  }
};

}  // namespace

TEST_CASE("a truth is exposed to the given mean luminance, and an estimate at the truth's exposure") {
  const brdf_table truth = formula("gold-metal");
  const auto seen = room_delta_e().expose(truth);
  const gonio::render::sphere_colours colours = room_delta_e().sphere().apply(truth);
  CHECK(mean_luminance(seen.exposure * colours) == doctest::Approx(0.18).epsilon(1e-12));
  for (Eigen::Index point = 0; point < colours.rows(); ++point) {
    const rgb expected = gonio::to_lab(seen.exposure * colours.row(point).transpose());
    CHECK((seen.lab.row(point).transpose() - expected).abs().maxCoeff() < 1e-10);
  }

  const sphere_delta_e brighter(room_cells(), headlight(), 12, 0.5);
  CHECK(mean_luminance(brighter.expose(truth).exposure * brighter.sphere().apply(truth)) ==
        doctest::Approx(0.5).epsilon(1e-12));
  const auto again = room_delta_e().look(truth, seen.exposure);
  CHECK((again.lab == seen.lab).all());
  CHECK(again.exposure == seen.exposure);
}

TEST_CASE("flat spheres differ as their colours do") {
  // Every point has the material's colour: grey at luminance 0.18, and an estimate of twice that.
  const sphere_delta_e flat(room_cells(), flat_light{}, 12);
  const double l = 116.0 * std::cbrt(0.18) - 16.0, twice = 116.0 * std::cbrt(0.36) - 16.0;
  const rgb grey = rgb::Constant(0.3);
  CHECK(flat.difference(matte(2.0 * grey), matte(grey)) == doctest::Approx(twice - l).epsilon(1e-4));
  CHECK(flat.difference(matte(rgb::Zero()), matte(grey)) == doctest::Approx(l).epsilon(1e-4));
  // Exchanged, the truth is brighter.
  CHECK(flat.difference(matte(grey), matte(2.0 * grey)) ==
        doctest::Approx(l - (116.0 * std::cbrt(0.09) - 16.0)).epsilon(1e-4));
  // A thousand times as bright is clipped to white.
  CHECK(flat.difference(matte(1000.0 * grey), matte(grey)) == doctest::Approx(100.0 - l).epsilon(1e-4));
}

TEST_CASE("a table does not differ from itself") {
  for (const char* name : {"red-paint", "gold-metal"})
    CHECK(room_delta_e().difference(formula(name), formula(name)) == 0.0);
}

TEST_CASE("a kept truth gives the same difference, the mean of those at the points") {
  const brdf_table estimate = formula("blue-rubber"), truth = formula("red-paint");
  const auto seen = room_delta_e().expose(truth);
  const double difference = room_delta_e().difference(estimate, truth);
  CHECK(room_delta_e().difference(estimate, seen) == difference);
  const auto estimate_seen = room_delta_e().look(estimate, seen.exposure);
  CHECK(sphere_delta_e::difference(estimate_seen, seen) == difference);
  CHECK(sphere_delta_e::differences(estimate_seen, seen).mean() == doctest::Approx(difference).epsilon(1e-13));
  CHECK(difference > 20.0);
}

TEST_CASE("the brightness of the light and of both materials does not matter") {
  gonio::image image = room().image();
  for (float& value : image) value *= 7.3f;
  const sphere_delta_e brighter(room_cells(), gonio::render::important_lights(environment_map(image), 200, 1), 12);
  const brdf_table estimate = formula("blue-rubber"), truth = formula("red-paint");
  const double difference = room_delta_e().difference(estimate, truth);
  CHECK(brighter.difference(estimate, truth) == doctest::Approx(difference).epsilon(1e-5));
  const auto darker = [](brdf_table table) {
    for (float& value : table.values()) value *= 0.125f;
    return table;
  };
  CHECK(room_delta_e().difference(darker(estimate), darker(truth)) == doctest::Approx(difference).epsilon(1e-12));
}

TEST_CASE("a few important lights judge as all of them do") {
  const sphere_delta_e all(room_cells(), gonio::render::all_lights(room()), 12);
  const sphere_delta_e few(room_cells(), gonio::render::important_lights(room(), 1000, 1), 12);
  for (const char* name : {"blue-rubber", "gold-metal"}) {
    const brdf_table estimate = formula(name), truth = formula("red-paint");
    CHECK(few.difference(estimate, truth) == doctest::Approx(all.difference(estimate, truth)).epsilon(0.01));
  }
}

TEST_CASE("a black truth is seen at exposure 1") {
  const auto seen = room_delta_e().expose(matte(rgb::Zero()));
  CHECK(seen.exposure == 1.0);
  CHECK(seen.lab.abs().maxCoeff() < 1e-12);
  CHECK(room_delta_e().difference(matte(rgb::Zero()), seen) == 0.0);
  CHECK(room_delta_e().difference(matte(rgb::Constant(0.5)), seen) > 10.0);
}

TEST_CASE("negative reflectance counts as zero for a sphere delta_e, cell by cell") {
  brdf_table negative = matte(rgb::Constant(0.3)), clamped = negative;
  for (Eigen::Index cell = 0; cell < std::ssize(room_cells()); cell += 3) {
    negative.set(cell, rgb(-5.0, 0.1, -1e-3));
    clamped.set(cell, rgb(0.0, 0.1, 0.0));
  }
  CHECK(room_delta_e().difference(negative, clamped) == 0.0);
  CHECK(room_delta_e().expose(negative).exposure == room_delta_e().expose(clamped).exposure);
}

TEST_CASE("the image of differences has the colour of each point's difference") {
  const auto truth = room_delta_e().expose(formula("red-paint"));
  const auto estimate = room_delta_e().look(formula("gold-metal"), truth.exposure);
  const rgb background(0.25, 0.5, 0.75);
  const gonio::image image = room_delta_e().difference_image(estimate, truth, 40.0, background);
  REQUIRE(image.shape(0) == 12);
  REQUIRE(image.shape(1) == 12);
  CHECK((gonio::pixel(image, 0, 0) == background).all());
  const auto& points = room_delta_e().sphere().points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Index at = i;
    const double difference = (estimate.lab.row(at) - truth.lab.row(at)).matrix().norm();
    const rgb expected = gonio::render::difference_colour(difference, 40.0);
    CHECK((gonio::pixel(image, points[i].row, points[i].column) - expected).abs().maxCoeff() < 1e-6);
  }
  // Zero difference is light.
  const gonio::image none = room_delta_e().difference_image(truth, truth);
  CHECK((gonio::pixel(none, 6, 6) - gonio::render::sequential_colour(0.0)).abs().maxCoeff() < 1e-6);
  CHECK((gonio::pixel(none, 0, 0) == rgb(0.0, 0.0, 0.0)).all());
}

TEST_CASE("the number of threads does not change a byte of what a sphere delta_e says") {
  const brdf_table a = formula("gold-metal"), b = formula("blue-rubber");
  const auto lights = gonio::render::important_lights(room(), 200, 1);
  const sphere_delta_e one(room_cells(), lights, 12, sphere_delta_e::middle_grey, {1});
  CHECK(one.difference(a, b, {1}) == room_delta_e().difference(a, b, {4}));
}

TEST_CASE("other cells and an impossible exposure are refused") {
  const brdf_table other(gonio::valid_cells(gonio::grid({20, 15, 31})));
  CHECK_THROWS_AS((void)room_delta_e().expose(other), gonio::error);
  CHECK_THROWS_AS((void)room_delta_e().difference(other, matte(rgb::Ones())), gonio::error);
  for (const double impossible : {0.0, -1.0, std::nan(""), HUGE_VAL})
    CHECK_THROWS_WITH_AS((void)sphere_delta_e(room_cells(), headlight(), 12, impossible),
                         doctest::Contains("mean luminance"), gonio::error);
}
