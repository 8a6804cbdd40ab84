#pragma once
/// Camera calibrations written by OpenCV (cv::FileStorage, .yml, .yaml or .xml): image size, pinhole and lens
/// distortion. Reads `image_width`, `image_height`, the 3 x 3 matrix `camera_matrix` and the four or five numbers of
/// `distortion_coefficients`, also under the names in OpenCV's own programs and tutorials.
/// https://docs.opencv.org/4.x/da/d56/classcv_1_1FileStorage.html
///
/// OpenCV counts pixels from the centre of the first pixel, gonio from its border: half a pixel is added to the
/// principal point.

#include <gonio/core/lens_distortion.hpp>
#include <gonio/core/pinhole_camera.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// The intrinsics and the lens distortion of a camera, without its pose.
struct camera_calibration {
  camera_intrinsics intrinsics;
  lens_distortion distortion;
};

/// Reads a calibration. Throws gonio::error naming the entry that is missing or wrong: a matrix whose shape does not
/// fit its numbers, a size that is not a whole number, focal lengths that are not positive, skewed axes, nonzero
/// coefficients after k3, or a fisheye lens (OpenCV's `fisheye_model`, ROS's `distortion_model` equidistant), whose
/// coefficients have another meaning. Errors call the text `name`.
[[nodiscard]] camera_calibration read_camera_calibration(std::string_view text, const std::string& name);

/// Reads a calibration file.
[[nodiscard]] camera_calibration read_camera_calibration(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/setups/impl/camera_calibration.ipp>
#endif
