#include "scratch.hpp"
#include <gonio/io/setups/near_field_setup.hpp>
#include <gonio/io/text/text.hpp>

#include <doctest/doctest.h>

#include <string>
#include <variant>

using gonio::io::read_near_field_setup;

namespace {

const std::string complete =
    "# first of two\nsize 640 480\nfocal_length 1200 1100.5\nprincipal_point 310 245 # measured\nposition 0.5 -0.1 .3\n"
    "target 0.01 0 0\nup 0 1 0\n\nlight_angles 50 180\r\nirradiance 3 2 1.5\nregion 0.1 0.02 -0.03\n"
    "window 100 80 400 300\nsaturation 0.98\nblock 4\n";
const std::string smallest = "size 8 6\nfocal_length 10\nposition 0 1 1\ntarget 0 0 0\nlight 0 0 2\nregion 1\n";

/// The distant light of a set-up.
const gonio::directional_light& light_of(const gonio::capture::near_field_setup& setup) {
  return std::get<gonio::directional_light>(setup.light);
}

/// Returns the smallest file with a line replaced by another.
std::string with(const std::string& line, const std::string& other) {
  std::string text = smallest;
  const std::size_t at = text.find(line);
  REQUIRE(at != std::string::npos);
  return text.replace(at, line.size(), other);
}

}  // namespace

TEST_CASE("every entry is read") {
  const auto setup = read_near_field_setup(complete, "first.txt");
  const auto& intrinsics = setup.camera.intrinsics();
  CHECK(intrinsics.columns == 640);
  CHECK(intrinsics.rows == 480);
  CHECK(intrinsics.focal_length_x == 1200.0);
  CHECK(intrinsics.focal_length_y == 1100.5);
  CHECK(intrinsics.principal_x == 310.0);
  CHECK(intrinsics.principal_y == 245.0);
  CHECK(setup.camera.position() == Eigen::Vector3d(0.5, -0.1, 0.3));
  // The target is on the optical axis, and upwards in the world is upwards in the image, where rows grow downwards.
  const auto target = setup.camera.project({0.01, 0.0, 0.0}), above = setup.camera.project({0.01, 0.1, 0.0});
  CHECK((*target - Eigen::Vector2d(310.0, 245.0)).norm() < 1e-9);
  CHECK(above->y() < 245.0);
  CHECK((light_of(setup).towards - gonio::spherical_direction(gonio::radians(50), gonio::radians(180))).norm() < 1e-12);
  CHECK((light_of(setup).irradiance == gonio::rgb(3.0, 2.0, 1.5)).all());
  REQUIRE(setup.disc);
  CHECK(setup.disc->radius == 0.1);
  CHECK(setup.disc->centre == Eigen::Vector2d(0.02, -0.03));
  REQUIRE(setup.window);
  CHECK(setup.window->column == 100);
  CHECK(setup.window->row == 80);
  CHECK(setup.window->columns == 400);
  CHECK(setup.window->rows == 300);
  CHECK(setup.saturation == 0.98);
  CHECK(setup.block == 4);
}

TEST_CASE("missing entries have the documented defaults") {
  const auto setup = read_near_field_setup(smallest, "first.txt");
  CHECK(setup.camera.intrinsics().focal_length_y == 10.0);
  CHECK(setup.camera.intrinsics().principal_x == 4.0);
  CHECK(setup.camera.intrinsics().principal_y == 3.0);
  CHECK(light_of(setup).towards == gonio::direction(0.0, 0.0, 1.0));
  CHECK((light_of(setup).irradiance == 1.0).all());
  CHECK(setup.disc->centre == Eigen::Vector2d(0.0, 0.0));
  CHECK_FALSE(setup.window);
  CHECK_FALSE(setup.saturation);
  CHECK(setup.block == 1);
  const auto windowed = read_near_field_setup(with("region 1", "window 0 0 8 6\nirradiance 2"), "first.txt");
  CHECK_FALSE(windowed.disc);
  CHECK((light_of(windowed).irradiance == 2.0).all());
}

TEST_CASE("a rotation is the camera's axes, row by row") {
  const auto setup = read_near_field_setup(with("target 0 0 0", "rotation 0 1 0  1 0 0  0 0 -1"), "first.txt");
  CHECK(setup.camera.pinhole().rotation().row(0) == Eigen::RowVector3d(0.0, 1.0, 0.0));
  CHECK(setup.camera.pinhole().rotation().row(1) == Eigen::RowVector3d(1.0, 0.0, 0.0));
  CHECK(setup.camera.ray_through(4.0, 3.0).towards == gonio::direction(0.0, 0.0, -1.0));
}

TEST_CASE("a bad set-up is refused; the error names the file and, if possible, the line") {
  const auto refused = [](const std::string& text, std::initializer_list<std::string> words) {
    scratch::check_refused([&] { return read_near_field_setup(text, "first.txt"); }, words);
    scratch::check_refused([&] { return read_near_field_setup(text, "first.txt"); }, {"first.txt"});
  };
  refused(smallest + "lamps 3\n", {"line 7", "'lamps' is unknown", "light_angles"});
  refused(smallest + "size 8 6\n", {"line 7", "'size' is already in line 1"});
  refused(with("size 8 6", "size 8"), {"line 1", "'size' takes 2 numbers, not 1"});
  refused(with("focal_length 10", "focal_length 1 2 3"), {"line 2", "takes 1 or 2 numbers, not 3"});
  refused(with("size 8 6", "size 8 tall"), {"line 1", "'tall' is not a number"});
  refused(with("size 8 6", "size 8 5.5"), {"line 1", "5.5 is not a whole number from 1"});
  refused(with("size 8 6", "size 0 6"), {"line 1", "0 is not a whole number from 1"});
  refused(with("size 8 6", "size 8 1e300"), {"line 1", "1000000"});
  refused(with("focal_length 10", "focal_length -10"), {"focal lengths must be positive"});
  refused(with("position 0 1 1", "position 0 1 nan"), {"line 3", "not finite"});
  refused(with("position 0 1 1", "position 0 1 -1"), {"the camera is not above"});
  refused(with("position 0 1 1", "position 0 0 0"), {"target must differ from its position"});
  refused(with("position 0 1 1", "position 0 0 1"), {"its upward direction from its viewing direction"});
  refused(with("target 0 0 0", "rotation 1 0 0 0 1 0 0 0 2"), {"orthogonal"});
  refused(smallest + "rotation 1 0 0 0 1 0 0 0 1\n", {"line 7", "'rotation'", "'target'", "only one"});
  refused(with("target 0 0 0", "rotation 1 0 0 0 1 0 0 0 1\nup 0 0 1"), {"'rotation'", "'up'", "only one"});
  refused(smallest + "light_angles 0 0\n", {"line 5", "'light_angles'", "only one"});
  refused(with("light 0 0 2", "light 0 0 0"), {"line 5", "not 0 0 0"});
  refused(with("light 0 0 2", "light 1 0 -1"), {"the light is at or below"});
  refused(with("light 0 0 2", "light_angles 90 0"), {"line 5", "90 degrees", "less than 90"});
  refused(with("light 0 0 2", "light_angles 9 400"), {"line 5", "400 degrees"});
  refused(smallest + "irradiance 1 2\n", {"line 7", "1 or 3 numbers"});
  refused(smallest + "irradiance 1 0 1\n", {"line 7", "'irradiance': must be positive in each channel"});
  refused(with("region 1", "region 0"), {"positive radius"});
  refused(with("region 1", "window 0 0 9 6"), {"window", "8 x 6"});
  refused(with("region 1", "window -1 0 8 6"), {"line 6", "-1 is not a whole number from 0"});
  refused(with("light 0 0 2", "lamp 1 0 0"), {"the light is at or below"});
  refused(smallest + "lamp 1 0 1\n", {"line 5", "'lamp' already states the light's location"});
  refused(smallest + "lamp_radius 1\n", {"line 7", "'lamp_radius'", "light_half_angle"});
  refused(smallest + "light_half_angle 50\n", {"line 7", "'light_half_angle'", "0 to 45"});
  refused(with("light 0 0 2", "lamp 1 0 1\nlight_half_angle 1"), {"'light_half_angle'", "lamp_radius"});
  refused(with("light 0 0 2", "lamp 1 0 1\nlamp_radius -1"), {"'lamp_radius'", "must not be negative"});
  refused(smallest + "intensity 2\n", {"line 7", "for a distant light give irradiance"});
  refused(smallest + "distortion -2000 0 0 0\n", {"folds within the image"});
  refused(smallest + "white_plane 0 0 0 0 0 1\n", {"needs 'white_reflectance'"});
  refused(smallest + "white_reflectance 0\n", {"line 7", "above 0 and up to 1"});
  refused(smallest + "saturation 0\n", {"saturation must be positive"});
  refused(smallest + "block 0\n", {"line 7", "0 is not a whole number from 1"});
}

TEST_CASE("a lens, a lamp and a white reference are read as for a sphere") {
  const auto setup = read_near_field_setup(
      with("light 0 0 2",
           "lamp 3 4 5\nintensity 2\nlamp_radius 0.25\ndistortion -0.2 0.05 0.001 0.002\nwhite_reflectance 0.98\n"
           "white_plane 0 0 -1 0 0 1"),
      "first.txt");
  const auto& lamp = std::get<gonio::capture::point_lamp>(setup.light);
  CHECK(lamp.position == Eigen::Vector3d(3.0, 4.0, 5.0));
  CHECK((lamp.intensity == 2.0).all());
  CHECK(lamp.radius == 0.25);
  CHECK(setup.camera.distortion().k2 == 0.05);
  CHECK(setup.white_reflectance == 0.98);
  CHECK(setup.white_plane->point.z() == -1.0);
  const auto wide = read_near_field_setup(with("focal_length 10", "field_of_view 90"), "first.txt");
  CHECK(wide.camera.intrinsics().focal_length_x == doctest::Approx(4.0));
}

TEST_CASE("with a calibration, a set-up must state neither size nor lens") {
  const gonio::io::camera_calibration calibration{gonio::camera_intrinsics::square(40, 0.5), {.k1 = -0.1}};
  const std::string bare = "position 0 1 1\ntarget 0 0 0\nlight 0 0 2\nregion 1\n";
  const auto setup = read_near_field_setup(bare, "first.txt", calibration);
  CHECK(setup.camera.intrinsics().columns == 40);
  CHECK(setup.camera.distortion().k1 == -0.1);
  scratch::check_refused([&] { return read_near_field_setup(smallest, "first.txt", calibration); },
                         {"line 1", "'size'", "the calibration already states it"});
}

TEST_CASE("a missing entry is named") {
  const auto missing = [](const std::string& line, const std::string& name) {
    scratch::check_refused([&] { return read_near_field_setup(with(line, ""), "first.txt"); },
                           {"first.txt: " + name + " is missing"});
  };
  missing("size 8 6", "'size'");
  missing("focal_length 10", "'focal_length' or 'field_of_view'");
  missing("position 0 1 1", "'position'");
  missing("target 0 0 0", "'target' or 'rotation'");
  missing("light 0 0 2", "'light' or 'light_angles' or 'lamp'");
  missing("region 1", "'region' or 'window'");
}

TEST_CASE("set-up files are read, unreadable ones are refused") {
  const scratch::folder here;
  scratch::put(here / "first.txt", complete);
  CHECK(gonio::io::read_near_field_setup(here / "first.txt").block == 4);
  scratch::check_refuses_non_files([](const auto& path) { return gonio::io::read_near_field_setup(path); });
  scratch::check_survives_damage(scratch::bytes_of(complete), 2000, [](std::span<const std::byte> bytes) {
    return read_near_field_setup(gonio::io::as_text(bytes), "damaged.txt");
  });
}
