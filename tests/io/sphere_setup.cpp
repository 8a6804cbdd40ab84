#include <gonio/io/setups/sphere_setup.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <variant>

using gonio::io::read_camera_calibration;
using gonio::io::read_sphere_setup;

namespace {

const std::string sphere_lens = "size 64 48\nfield_of_view 20\n";
const std::string sphere_pose = "position 0 0 12\ntarget 0 0 0\nup 0 1 0\n";

void refuses_setup(const std::string& text, const std::string& why) {
  CAPTURE(text);
  CAPTURE(why);
  try {
    static_cast<void>(read_sphere_setup(text, "setup.txt"));
    FAIL("was not refused");
  } catch (const gonio::error& refusal) {
    CAPTURE(refusal.what());
    CHECK(std::string(refusal.what()).find(why) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("a set-up of a sphere is read") {
  const auto setup = read_sphere_setup(sphere_lens + sphere_pose +
                                           "distortion -0.2 0.05 0.001 0.002\nlamp 3 4 5\nintensity 2\nsphere 0.5\n"
                                           "white_reflectance 0.98\nwhite_plane 0 0 -1 0 0 1\nsaturation 9\n",
                                       "setup.txt");
  CHECK(setup.camera.distortion().k2 == 0.05);
  CHECK(setup.camera.distortion().p2 == 0.002);
  CHECK(setup.camera.intrinsics().focal_length_x == doctest::Approx(32.0 / std::tan(gonio::radians(10.0))));
  CHECK(std::get<gonio::capture::point_lamp>(setup.light).position == Eigen::Vector3d(3.0, 4.0, 5.0));
  CHECK(setup.radius == 0.5);
  CHECK(!setup.centre);
  CHECK(setup.white_reflectance == 0.98);
  CHECK(setup.white_plane->normal.z() == 1.0);
  CHECK(setup.options.saturation == 9.0);
}

TEST_CASE("bad set-ups of a sphere are refused") {
  const std::string good = sphere_lens + sphere_pose + "lamp 3 4 5\n";
  CHECK_NOTHROW(read_sphere_setup(good, "setup.txt"));
  refuses_setup(sphere_lens + sphere_pose, "'light' or 'light_angles' or 'lamp' is missing");
  refuses_setup("size 64 48\n" + sphere_pose + "lamp 1 2 3\n", "'focal_length' or 'field_of_view' is missing");
  refuses_setup(good + "light 0 0 1\n", "the light's location");
  refuses_setup(good + "irradiance 2\n", "for a lamp give intensity");
  refuses_setup(good + "sphere -1\n", "the radius must be positive");
  refuses_setup(good + "outline 3 4 5\n", "needs 'sphere'");
  refuses_setup(good + "sphere 1 0 0 0\noutline 3 4 5\n", "give only one of them");
  refuses_setup(good + "white_reflectance 1.2\n", "above 0 and up to 1");
  refuses_setup(good + "white_plane 0 0 0 0 0 1\n", "needs 'white_reflectance'");
  refuses_setup(good + "distortion -20 0 0 0\n", "folds within the image: at a radius of");
  for (const char* cosine : {"0", "1", "1.2", "-0.5"})
    refuses_setup(good + "smallest_cosine " + cosine + "\n", "expected above 0 and below 1");
  CHECK(read_sphere_setup(good + "smallest_cosine 0.3\n", "setup.txt").options.smallest_cosine == 0.3);
  refuses_setup(good + "region 1\n", "'region' is unknown");
}
