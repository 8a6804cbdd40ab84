#include <gonio/io/setups/camera_calibration.hpp>
#include <gonio/io/setups/sphere_setup.hpp>

#include <doctest/doctest.h>

#include <string>

using gonio::io::read_camera_calibration;

namespace {

/// As OpenCV's calibration program writes it.
const std::string calibration_yaml =
    "%YAML:1.0\n---\ncalibration_time: \"now\"\nimage_width: 640\nimage_height: 480\n"
    "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 5.3e+02, 0., 3.2e+02, 0.,\n"
    "       5.4e+02, 2.4e+02, 0., 0., 1. ]\n"
    "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
    "   data: [ -0.28, 0.1, 0.001, -0.002, 0.01 ]\navg_reprojection_error: 0.2\n";
const std::string calibration_xml =
    "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>640</image_width>\n<image_height>480</image_height>\n"
    "<camera_matrix type_id=\"opencv-matrix\">\n  <rows>3</rows>\n  <cols>3</cols>\n  <dt>d</dt>\n  <data>\n"
    "    5.3e+02 0. 3.2e+02 0. 5.4e+02 2.4e+02 0. 0. 1.</data></camera_matrix>\n"
    "<distortion_coefficients type_id=\"opencv-matrix\">\n  <rows>1</rows>\n  <cols>5</cols>\n  <dt>d</dt>\n"
    "  <data>\n    -0.28 0.1 0.001 -0.002 0.01</data></distortion_coefficients>\n</opencv_storage>\n";

std::string changed(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

void refuses_calibration(const std::string& text, const std::string& why) {
  CAPTURE(why);
  try {
    static_cast<void>(read_camera_calibration(text, "camera.yml"));
    FAIL("was not refused");
  } catch (const gonio::error& refusal) {
    CAPTURE(refusal.what());
    CHECK(std::string(refusal.what()).find(why) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("OpenCV's calibrations are read, YAML and XML") {
  for (const std::string& text : {calibration_yaml, calibration_xml}) {
    const auto found = read_camera_calibration(text, "camera");
    CHECK(found.intrinsics.columns == 640);
    CHECK(found.intrinsics.rows == 480);
    CHECK(found.intrinsics.focal_length_x == 530.0);
    CHECK(found.intrinsics.focal_length_y == 540.0);
    CHECK(found.intrinsics.principal_x == 320.5);  // from the border of the first pixel
    CHECK(found.intrinsics.principal_y == 240.5);
    CHECK(found.distortion.k1 == -0.28);
    CHECK(found.distortion.p2 == -0.002);
    CHECK(found.distortion.k3 == 0.01);
  }
}

TEST_CASE("calibrations of fisheye lenses are refused: their coefficients have another meaning") {
  refuses_calibration("%YAML:1.0\n---\nfisheye_model: 1\n" + calibration_yaml.substr(14),
                      "'fisheye_model' is an unsupported lens model");
  refuses_calibration(calibration_yaml + "distortion_model: equidistant\n",
                      "'distortion_model' 'equidistant' is an unsupported lens");
  for (const char* usual : {"fisheye_model: 0\n", "distortion_model: plumb_bob\n", "distortion_model: \"plumb_bob\"\n"})
    CHECK(read_camera_calibration(calibration_yaml + usual, "camera").distortion.k1 == -0.28);
}

TEST_CASE("a set-up takes its camera from a calibration or states it, not both") {
  const auto calibration = read_camera_calibration(calibration_yaml, "camera.yml");
  const std::string pose = "position 0 0 12\ntarget 0 0 0\nup 0 1 0\nlamp 3 4 5\n";
  const auto setup = gonio::io::read_sphere_setup(pose, "setup.txt", calibration);
  CHECK(setup.camera.intrinsics().columns == 640);
  CHECK(setup.camera.distortion().k1 == -0.28);
  CHECK_THROWS_AS(gonio::io::read_sphere_setup(pose + "size 640 480\n", "setup.txt", calibration), gonio::error);
}

TEST_CASE("bad calibrations are refused") {
  refuses_calibration("nonsense", "is not a calibration file of OpenCV");
  refuses_calibration(changed(calibration_yaml, "image_width: 640\n", ""), "'image_width' is missing");
  refuses_calibration(changed(calibration_yaml, "image_width: 640", "image_width: -640"), "must be a whole number");
  refuses_calibration(changed(calibration_yaml, "5.3e+02, 0.,", "5.3e+02, 0.5,"), "must be fx 0 cx");
  refuses_calibration(changed(calibration_yaml, "5.3e+02, 0.,", "5.3e+02,"), "holds 8 numbers");
  refuses_calibration(changed(calibration_yaml, "5.3e+02", "nan"), "'camera_matrix' holds");
  refuses_calibration(changed(calibration_yaml, "rows: 5", "rows: 999999999"), "'distortion_coefficients'");
  refuses_calibration(changed(calibration_xml, "</camera_matrix>", ""), "is not closed");
}
