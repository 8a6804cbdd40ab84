#include <gonio/core/pinhole_camera.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <functional>
#include <limits>

using gonio::camera_intrinsics;
using gonio::pinhole_camera;

namespace {

/// Returns one of a million evenly spaced numbers in a range.
double number_between(double low, double high) { return low + (high - low) * 1e-6 * *rc::gen::inRange(0, 1'000'001); }

Eigen::Vector3d vector_in_box(double half_size) {
  const double x = number_between(-half_size, half_size), y = number_between(-half_size, half_size);
  return {x, y, number_between(-half_size, half_size)};
}

pinhole_camera any_camera() {
  const camera_intrinsics intrinsics{480,
                                     640,
                                     number_between(100.0, 3000.0),
                                     number_between(100.0, 3000.0),
                                     number_between(0.0, 640.0),
                                     number_between(0.0, 480.0)};
  const Eigen::Vector3d position = vector_in_box(5.0);
  const Eigen::Vector3d forward = vector_in_box(1.0), up = vector_in_box(1.0);
  RC_PRE(forward.norm() > 1e-2 && up.norm() > 1e-2);
  RC_PRE(forward.normalized().cross(up.normalized()).norm() > 1e-2);
  return pinhole_camera::look_at(intrinsics, position, position + forward, up);
}

}  // namespace

TEST_CASE("a point on a pixel's ray is projected to that pixel") {
  CHECK(rc::check([] {
    const pinhole_camera camera = any_camera();
    const double column = number_between(0.0, 640.0), row = number_between(0.0, 480.0);
    const gonio::ray line = camera.ray_through(column, row);
    RC_ASSERT(std::abs(line.towards.norm() - 1.0) < 1e-12);
    const auto seen = camera.project(line.origin + number_between(0.1, 100.0) * line.towards);
    RC_ASSERT(seen.has_value());
    RC_ASSERT((*seen - Eigen::Vector2d(column, row)).norm() < 1e-6);
  }));
}

TEST_CASE("the ray of a point's pixel passes through the point") {
  CHECK(rc::check([] {
    const pinhole_camera camera = any_camera();
    const Eigen::Vector3d point = vector_in_box(5.0);
    const auto seen = camera.project(point);
    RC_PRE(seen.has_value());
    const gonio::ray line = camera.ray_through(seen->x(), seen->y());
    const Eigen::Vector3d to_point = point - line.origin;
    RC_ASSERT(line.towards.dot(to_point) > 0.0);
    RC_ASSERT(line.towards.cross(to_point).norm() < 1e-9 * (1.0 + to_point.norm()));
  }));
}

TEST_CASE("look_at is a rotation that puts the target on the axis, right to the right and up upwards") {
  CHECK(rc::check([] {
    const pinhole_camera camera = any_camera();
    const Eigen::Matrix3d& rotation = camera.rotation();
    RC_ASSERT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    RC_ASSERT(std::abs(rotation.determinant() - 1.0) < 1e-12);
  }));
  const auto intrinsics = camera_intrinsics::square(100, gonio::radians(60));
  const auto camera = pinhole_camera::look_at(intrinsics, {3.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  CHECK((*camera.project({0.0, 0.0, 0.0}) - Eigen::Vector2d(50.0, 50.0)).norm() < 1e-12);
  CHECK(camera.project({0.0, 0.0, 1.0})->y() < 50.0);  // rows are counted downwards
  CHECK(camera.project({0.0, 1.0, 0.0})->x() > 50.0);  // for a camera that looks along -x, y is to the right
  CHECK_FALSE(camera.project({4.0, 0.0, 0.0}).has_value());
  CHECK_FALSE(camera.project({3.0, 1.0, 0.0}).has_value());
}

TEST_CASE("a square image spans its field of view") {
  const auto intrinsics = camera_intrinsics::square(200, gonio::radians(40));
  const pinhole_camera camera(intrinsics, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  const auto left = camera.ray_through(0.0, 100.0).towards, right = camera.ray_through(200.0, 100.0).towards;
  CHECK(gonio::degrees(std::acos(left.dot(right))) == doctest::Approx(40.0));
  CHECK(left.x() < 0.0);
  CHECK(camera.ray_through(100.0, 0.0).towards.y() < 0.0);
  CHECK(camera.ray_through(100.0, 100.0).towards == gonio::direction(0.0, 0.0, 1.0));
}

TEST_CASE("a ray meets the ground from above alone") {
  const gonio::direction down = gonio::direction(3.0, 0.0, -4.0) / 5.0;
  const auto point = gonio::ray{{1.0, 2.0, 4.0}, down}.at_ground();
  REQUIRE(point.has_value());
  CHECK((*point - Eigen::Vector3d(4.0, 2.0, 0.0)).norm() < 1e-12);
  CHECK(point->z() == 0.0);
  CHECK_FALSE(gonio::ray{{1.0, 2.0, 4.0}, -down}.at_ground().has_value());
  CHECK_FALSE(gonio::ray{{1.0, 2.0, -4.0}, down}.at_ground().has_value());
  CHECK_FALSE(gonio::ray{{1.0, 2.0, -4.0}, -down}.at_ground().has_value());
  CHECK_FALSE(gonio::ray{{1.0, 2.0, 4.0}, {1.0, 0.0, 0.0}}.at_ground().has_value());
}

TEST_CASE("impossible cameras are refused") {
  const auto refused = [](const std::function<void(camera_intrinsics&, Eigen::Matrix3d&, Eigen::Vector3d&)>& change,
                          const char* why) {
    camera_intrinsics intrinsics = camera_intrinsics::square(10, 1.0);
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    CHECK_NOTHROW(pinhole_camera(intrinsics, rotation, position));
    change(intrinsics, rotation, position);
    CHECK_THROWS_WITH_AS(pinhole_camera(intrinsics, rotation, position), doctest::Contains(why), gonio::error);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](auto& i, auto&, auto&) { i.rows = 0; }, "needs pixels");
  refused([](auto& i, auto&, auto&) { i.columns = 0; }, "needs pixels");
  refused([](auto& i, auto&, auto&) { i.focal_length_x = 0.0; }, "must be positive");
  refused([](auto& i, auto&, auto&) { i.focal_length_y = -3.0; }, "must be positive, not");
  refused([](auto& i, auto&, auto&) { i.principal_x = nan; }, "finite");
  refused([](auto&, auto&, auto& p) { p.y() = nan; }, "finite");
  refused([](auto&, auto& r, auto&) { r(1, 1) = 0.99; }, "orthogonal");
  refused([](auto&, auto& r, auto&) { r(2, 2) = -1.0; }, "determinant 1");
  refused([](auto&, auto& r, auto&) { r(0, 0) = nan; }, "orthogonal");
  // Four decimals, as in a file, are accurate enough.
  CHECK_NOTHROW(pinhole_camera(camera_intrinsics::square(10, 1.0),
                               (Eigen::Matrix3d() << 0.7071, -0.7071, 0, 0.7071, 0.7071, 0, 0, 0, 1).finished(),
                               Eigen::Vector3d::Zero()));
  const auto intrinsics = camera_intrinsics::square(10, 1.0);
  const Eigen::Vector3d here(1.0, 2.0, 3.0), up(0.0, 0.0, 1.0);
  CHECK_THROWS_AS(pinhole_camera::look_at(intrinsics, here, here, up), gonio::error);
  CHECK_THROWS_AS(pinhole_camera::look_at(intrinsics, here, here + 2.0 * up, up), gonio::error);
  CHECK_THROWS_AS(pinhole_camera::look_at(intrinsics, here, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}), gonio::error);
}
