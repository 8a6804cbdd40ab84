#include <gonio/core/lens_distortion.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <string>

namespace {

gonio::pinhole_camera distortion_pinhole() {
  return gonio::pinhole_camera::look_at({480, 640, 700.0, 690.0, 310.0, 250.0}, {0.1, -0.2, 3.0}, {0.0, 0.0, 0.0},
                                        {0.0, 1.0, 0.0});
}

void refuses_distortion(const gonio::lens_distortion& distortion, const std::string& why) {
  CAPTURE(why);
  try {
    static_cast<void>(gonio::lens_camera(distortion_pinhole(), distortion));
    FAIL("was not refused");
  } catch (const gonio::error& refusal) {
    CHECK(std::string(refusal.what()).find(why) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("points are shown where OpenCV's formula shows them") {
  // cv::projectPoints of (0.3, -0.2, 1) with unit focal length and these coefficients, computed by hand: r^2 = 0.13.
  const gonio::lens_distortion distortion{.k1 = -0.2, .k2 = 0.05, .p1 = 0.001, .p2 = -0.002, .k3 = 0.01};
  const double radial = 1.0 - 0.2 * 0.13 + 0.05 * 0.0169 + 0.01 * 0.002197;
  const Eigen::Vector2d shown = distortion.distorted({0.3, -0.2});
  CHECK(shown.x() == doctest::Approx(0.3 * radial + 2 * 0.001 * -0.06 - 0.002 * (0.13 + 0.18)).epsilon(1e-14));
  CHECK(shown.y() == doctest::Approx(-0.2 * radial + 0.001 * (0.13 + 0.08) + 2 * -0.002 * -0.06).epsilon(1e-14));
}

TEST_CASE("a point on the ray of a pixel is projected to that pixel") {
  CHECK(rc::check([] {
    const auto within = [](int low, int high, double scale) { return *rc::gen::inRange(low, high) * scale; };
    const gonio::lens_distortion distortion{.k1 = within(-200, 200, 1e-3),
                                            .k2 = within(-20, 50, 1e-3),
                                            .p1 = within(-20, 20, 1e-4),
                                            .p2 = within(-20, 20, 1e-4),
                                            .k3 = within(0, 20, 1e-3)};
    const gonio::lens_camera camera(distortion_pinhole(), distortion);
    const double column = within(1, 640, 0.999), row = within(1, 480, 0.999);
    const gonio::ray line = camera.ray_through(column, row);
    const auto back = camera.project(line.origin + 2.5 * line.towards);
    RC_ASSERT(back.has_value());
    RC_ASSERT(std::abs(back->x() - column) < 1e-6);
    RC_ASSERT(std::abs(back->y() - row) < 1e-6);
  }));
}

TEST_CASE("points that tangential coefficients move inwards are seen up to the corners") {
  for (const double p : {0.03, -0.03}) {
    const gonio::lens_camera camera(distortion_pinhole(), {.p1 = p, .p2 = p});
    for (const double column : {0.5, 639.5})
      for (const double row : {0.5, 479.5}) {
        const gonio::ray line = camera.ray_through(column, row);
        const auto back = camera.project(line.origin + 2.5 * line.towards);
        REQUIRE(back.has_value());
        CHECK((*back - Eigen::Vector2d(column, row)).norm() < 1e-6);
      }
  }
}

TEST_CASE("a lens of a narrow field, whose distortion folds far outside of it, is inverted") {
  const auto narrow = gonio::pinhole_camera::look_at({480, 640, 2100.0, 2070.0, 310.0, 250.0}, {0.1, -0.2, 3.0},
                                                     {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  const gonio::lens_camera camera(narrow, {.k1 = -0.3, .k3 = -0.03});
  for (double column = 0.5; column < 640.0; column += 71.0)
    for (double row = 0.5; row < 480.0; row += 68.0) {
      const gonio::ray line = camera.ray_through(column, row);
      const auto back = camera.project(line.origin + 2.5 * line.towards);
      REQUIRE(back.has_value());
      CHECK((*back - Eigen::Vector2d(column, row)).norm() < 1e-6);
    }
}

TEST_CASE("the derivative is that of differences") {
  const gonio::lens_distortion distortion{.k1 = -0.3, .k2 = 0.1, .p1 = 0.01, .p2 = -0.02, .k3 = 0.05};
  const Eigen::Vector2d at(0.4, 0.25);
  const Eigen::Matrix2d slope = distortion.jacobian(at);
  constexpr double step = 1e-6;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d along = step * Eigen::Vector2d::Unit(axis);
    const Eigen::Vector2d difference =
        (distortion.distorted(at + along) - distortion.distorted(at - along)) / (2 * step);
    CHECK((slope.col(axis) - difference).norm() < 1e-8);
  }
}

TEST_CASE("without coefficients it is the pinhole") {
  const gonio::lens_camera camera(distortion_pinhole());
  const gonio::ray a = camera.ray_through(17.0, 400.0), b = distortion_pinhole().ray_through(17.0, 400.0);
  CHECK((a.towards - b.towards).norm() < 1e-15);
  CHECK(camera.pixel_angle() == doctest::Approx(2.0 / 1390.0));
}

TEST_CASE("a distortion that folds within the image is refused, naming the radius") {
  // 1 + 3 k1 r^2 = 0 at r = 0.471, which is imaged at 0.314. The corner is at 0.589.
  refuses_distortion({.k1 = -1.5}, "folds within the image: at a radius of 0.47");
  refuses_distortion({.p1 = 0.9}, "folds within the image");
  refuses_distortion({.k1 = std::numeric_limits<double>::quiet_NaN()}, "must be finite");
  CHECK_NOTHROW(gonio::lens_camera(distortion_pinhole(), {.k1 = -0.3}));
}
