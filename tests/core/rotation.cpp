#include <gonio/core/rotation.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>

TEST_CASE("rotation: matrices that turn are rotations, those that stretch, shear or mirror are none") {
  CHECK(rc::check("a turn about any axis", [] {
    const auto number = [] { return *rc::gen::inRange(-100, 101) / 100.0; };
    const Eigen::Vector3d axis(number(), number(), 1.5);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(4.0 * number(), axis.normalized()).toRotationMatrix();
    RC_ASSERT(gonio::is_rotation(turn));
    RC_ASSERT(gonio::is_rotation((turn * 1e4).array().round() / 1e4));  // rounded to four decimals
    RC_ASSERT(!gonio::is_rotation(1.001 * turn));
    RC_ASSERT(!gonio::is_rotation(-turn));
    Eigen::Matrix3d sheared = turn;
    sheared.col(0) += 0.01 * sheared.col(1);
    RC_ASSERT(!gonio::is_rotation(sheared));
  }));
  CHECK(!gonio::is_rotation(Eigen::Matrix3d::Zero()));
  CHECK(!gonio::is_rotation(Eigen::Matrix3d::Constant(std::nan(""))));
}
