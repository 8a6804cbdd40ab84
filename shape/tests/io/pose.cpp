#include "io/scratch.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/shape/io/pose.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

using gonio::io::read_pose;

namespace {

gonio::shape::similarity_transform some_pose() {
  const Eigen::AngleAxisd turn(gonio::radians(50.0), Eigen::Vector3d(1.0, 2.0, 2.0) / 3.0);
  return {1.0, turn.toRotationMatrix(), {0.1, -20.0, 3e-7}};
}

}  // namespace

TEST_CASE("pose: a written pose is read back") {
  const scratch::folder here;
  const auto pose = some_pose();
  gonio::io::write_pose(here / "pose.txt", pose);
  const auto read = read_pose(here / "pose.txt");
  CHECK((read.rotation - pose.rotation).norm() < 1e-15);
  CHECK(read.translation == pose.translation);
  CHECK(read.scale == 1.0);
}

TEST_CASE("pose: a matrix, or a rotation and a translation, also of four decimals") {
  const scratch::folder here;
  scratch::put(here / "matrix.txt", "# from scan to model\n0 -1 0 5\n\n1 0 0 -6.5\n0\t0  1 7\n0 0 0 1\n");
  scratch::put(here / "parts.txt", "translation 5 -6.5 7\nrotation 0 -1 0  1 0 0  0 0 1  # a quarter\n");
  for (const char* file : {"matrix.txt", "parts.txt"}) {
    const auto pose = read_pose(here / file);
    CHECK((pose(Eigen::Vector3d(1.0, 0.0, 0.0)) - Eigen::Vector3d(5.0, -5.5, 7.0)).norm() < 1e-12);
    CHECK((pose.inverse()(Eigen::Vector3d(5.0, -6.5, 7.0))).norm() < 1e-12);
  }
  scratch::put(here / "rounded.txt", "0.8660 -0.5000 0 0\n0.5000 0.8660 0 0\n0 0 1 0\n0 0 0 1\n");
  const Eigen::Matrix3d rotation = read_pose(here / "rounded.txt").rotation;
  CHECK((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
  CHECK(rotation(1, 0) == doctest::Approx(0.5).epsilon(1e-4));
}

TEST_CASE("pose: text without a rigid motion is refused") {
  const scratch::folder here;
  const auto refuses = [&](const std::string& text, const std::string& words) {
    CAPTURE(text);
    scratch::put(here / "pose.txt", text);
    scratch::check_refused([&] { return read_pose(here / "pose.txt"); }, {"pose.txt", words});
  };
  const std::string last = "0 0 0 1\n";
  refuses("", "has 0 lines of numbers, expected 4");
  refuses("1 0 0 0\n0 1 0 0\n0 0 1 0\n", "has 3 lines of numbers, expected 4");
  refuses("1 0 0\n0 1 0\n0 0 1\n", "line 1: 'matrix' takes 4 numbers, not 3");
  refuses("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n", "line 4: the last line of a pose's matrix must be 0 0 0 1");
  refuses("1 0 0 0\n0 1 0 nan\n0 0 1 0\n" + last, "line 2");
  refuses("1 0 0 0\n0 1 0 x\n0 0 1 0\n" + last, "line 2");
  refuses("1.01 0 0 0\n0 1.01 0 0\n0 0 1.01 0\n" + last, "is not a rigid motion");  // scaled
  refuses("1 0 0 0\n0 1 0 0\n0 0 -1 0\n" + last, "is not a rigid motion");          // mirrored
  refuses("1 0.1 0 0\n0 1 0 0\n0 0 1 0\n" + last, "is not a rigid motion");         // sheared
  refuses("rotation 1 0 0 0 1 0 0 0 1\n", "'translation' is missing");
  refuses("translation 1 2 3\n", "'rotation' is missing");
  refuses("rotation 1 0 0 0\ntranslation 1 2 3\n", "line 1: 'rotation' takes 9 numbers, not 4");
  refuses("rotate 1 0 0 0 1 0 0 0 1\n", "line 1: 'rotate' is unknown, expected one of rotation, translation");
  refuses("rotation 2 0 0 0 2 0 0 0 2\ntranslation 1 2 3\n", "is not a rigid motion");
  scratch::check_refuses_non_files([](const auto& path) { return read_pose(path); });
}
