#include "lab/sphere_lab.hpp"
#include <gonio/capture/sphere_outline.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using gonio::capture::find_sphere;
using gonio::capture::placed_sphere;

namespace {

/// 200 x 160 pixels, at a distance of 12 radii from the sphere. The sphere's image spans about 120 pixels.
gonio::lens_camera outline_camera(const gonio::lens_distortion& distortion = {}) {
  return {gonio::pinhole_camera::look_at({160, 200, 720.0, 720.0, 100.0, 80.0}, {0.0, 0.0, 12.0}, {0.1, 0.0, 0.0},
                                         {0.0, 1.0, 0.0}),
          distortion};
}

/// A lamp whose direction, seen from the sphere, is at this angle from the camera.
gonio::capture::point_lamp outline_lamp(double angle) {
  return {15.0 * Eigen::Vector3d(std::sin(angle), 0.0, std::cos(angle)), gonio::rgb::Constant(700.0)};
}

void refuses_outline(const gonio::image& picture, const std::string& why) {
  CAPTURE(why);
  try {
    static_cast<void>(find_sphere(picture, outline_camera(), 1.0));
    FAIL("was not refused");
  } catch (const gonio::error& refusal) {
    CAPTURE(refusal.what());
    CHECK(std::string(refusal.what()).find(why) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("points of the outline give the sphere to the last digits, near and off the axis") {
  CHECK(rc::check([] {
    const auto within = [](int low, int high) { return *rc::gen::inRange(low, high) * 0.01; };
    const gonio::lens_camera camera = outline_camera({.k1 = within(-30, 30), .p1 = 0.002});
    const placed_sphere sphere{{within(-40, 40), within(-30, 30), within(-100, 500)}, 0.7};
    // The circle where the cone from the camera touches the sphere.
    const Eigen::Vector3d axis = (sphere.centre - camera.position()).normalized();
    const double sine = sphere.radius / (sphere.centre - camera.position()).norm(), cosine = std::sqrt(1 - sine * sine);
    const Eigen::Vector3d across = axis.unitOrthogonal(), beside = axis.cross(across);
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 40; ++i) {
      const double turn = i * 0.1;
      const Eigen::Vector3d towards = cosine * axis + sine * (std::cos(turn) * across + std::sin(turn) * beside);
      const auto seen_at = camera.project(camera.position() + towards);
      RC_PRE(seen_at.has_value());
      points.push_back(*seen_at);
    }
    const auto found = gonio::capture::fit_sphere(points, camera, sphere.radius);
    RC_ASSERT((found.sphere.centre - sphere.centre).norm() < 1e-5);
    RC_ASSERT(found.deviation < 1e-6);
  }));
}

TEST_CASE("a photograph gives the sphere to a fifth of a pixel, to a pixel if lit from behind") {
  const auto red_paint = gonio::model::formula_material("red-paint");
  const gonio::lens_camera camera = outline_camera({.k1 = -0.2, .k2 = 0.1, .p1 = 0.001});
  const placed_sphere sphere{{0.05, -0.03, 0.0}, 1.0};
  for (const double angle : {30.0, 61.0, 103.0, 131.0, 151.0}) {
    CAPTURE(angle);
    const auto picture = lab::photograph(red_paint, sphere, camera, outline_lamp(gonio::radians(angle)),
                                         {.noise = 0.02, .background = 1e-4, .vignetting = true});
    const auto found = find_sphere(picture, camera, 1.0, {.light = outline_lamp(gonio::radians(angle))});
    const Eigen::Vector3d off = found.sphere.centre - sphere.centre;
    const double pixel = 12.0 * camera.pixel_angle();
    CAPTURE(off.transpose());
    CAPTURE(found.deviation);
    CAPTURE(found.inliers);
    CAPTURE(found.edge_points);
    CHECK(off.head<2>().norm() < (angle < 110.0 ? 0.2 : 1.1) * pixel);
    CHECK(std::abs(off.z()) / 12.0 * 60.0 < (angle < 110.0 ? 0.25 : 1.3));  // error of the outline's radius in pixels
  }
}

TEST_CASE("an object that the border of a photograph cuts off has no edge there") {
  gonio::image picture = gonio::uniform_image(40, 60);
  for (std::size_t row = 10; row < 30; ++row)
    for (std::size_t column = 0; column < 20; ++column) gonio::set_pixel(picture, row, column, gonio::rgb::Ones());
  const auto points = gonio::capture::edge_points(picture);
  CHECK(points.size() > 30);
  for (const Eigen::Vector2d& at : points) {
    CAPTURE(at.transpose());
    const bool is_right = std::abs(at.x() - 20.0) < 1.0;
    CHECK((is_right || std::abs(at.y() - 10.0) < 1.0 || std::abs(at.y() - 30.0) < 1.0));
  }
}

TEST_CASE("a circle that somebody has drawn gives the sphere") {
  const gonio::lens_camera camera = outline_camera();
  const placed_sphere sphere{{0.0, 0.0, 0.0}, 1.0};
  const auto middle = camera.project(sphere.centre);
  REQUIRE(middle.has_value());
  const double radius = 720.0 * std::tan(std::asin(1.0 / 12.0));
  const auto found = gonio::capture::sphere_within({middle->x(), middle->y(), radius}, camera, 1.0);
  CHECK((found.sphere.centre - sphere.centre).norm() < 0.02);
}

TEST_CASE("photographs without a sphere are refused") {
  gonio::image picture = gonio::uniform_image(160, 200);
  refuses_outline(picture, "no sphere is found: nothing in the image differs from its border");
  for (std::size_t row = 40; row < 120; ++row)
    for (std::size_t column = 30; column < 170; ++column) gonio::set_pixel(picture, row, column, gonio::rgb::Ones());
  refuses_outline(picture, "no sphere is found");
  gonio::set_pixel(picture, 3, 5, gonio::rgb::Constant(std::numeric_limits<double>::quiet_NaN()));
  refuses_outline(picture, "pixel (row 3, column 5) is not a number");
  CHECK_THROWS_WITH_AS(gonio::capture::fit_sphere({}, outline_camera(), 1.0),
                       "no sphere is found: 0 edge points are too few for an outline", gonio::error);
  CHECK_THROWS_AS(gonio::capture::fit_sphere({}, outline_camera(), -1.0), gonio::error);
}

TEST_CASE("of the photographs of one sphere, the outline with the most inliers is used") {
  const auto find = [](const std::vector<Eigen::Index>& inliers) {
    return [inliers](Eigen::Index i) -> gonio::capture::fitted_outline {
      if (inliers[i] < 0) gonio::refuse("photograph " + std::to_string(i) + " shows too little");
      return {{Eigen::Vector3d::Constant(static_cast<double>(i)), 1.0}, 100, inliers[i]};
    };
  };
  CHECK(gonio::capture::fullest_outline(4, find({30, -1, 80, 50})).sphere.centre.x() == 2.0);
  CHECK(gonio::capture::fullest_outline(2, find({40, 40})).sphere.centre.x() == 0.0);
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::capture::fullest_outline(2, find({-1, -1}))),
                       "photograph 1 shows too little", gonio::error);
  CHECK_THROWS_AS(static_cast<void>(gonio::capture::fullest_outline(0, find({}))), gonio::error);
}
