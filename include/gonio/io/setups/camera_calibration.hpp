#pragma once
/// Calibrations of cameras as OpenCV writes them (cv::FileStorage, .yml, .yaml or .xml): size of the image, pinhole and
/// lens distortion. Read are `image_width` and `image_height`, a 3 x 3 matrix `camera_matrix` and four or five numbers
/// `distortion_coefficients`, also by the names that OpenCV's own programs and tutorials use.
/// https://docs.opencv.org/4.x/da/d56/classcv_1_1FileStorage.html
///
/// OpenCV counts pixels from the middle of the first one, gonio from its border: half a pixel is added to the principal
/// point.

#include <gonio/core/lens_distortion.hpp>
#include <gonio/core/pinhole_camera.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// What a camera and its lens do to rays, wherever it stands.
struct camera_calibration {
  camera_intrinsics intrinsics;
  lens_distortion distortion;
};

/// Throws gonio::error naming the entry that is missing or not what it should be: a matrix of another shape than its
/// numbers, a size that is no whole number, focal lengths that are not positive, axes that are not at right angles,
/// coefficients beyond k3 that are not zero, or a fisheye lens (OpenCV's `fisheye_model`, ROS's `distortion_model`
/// equidistant), whose four coefficients mean something else. `name` is what errors call the text.
[[nodiscard]] camera_calibration read_camera_calibration(std::string_view text, const std::string& name);

/// Reads a calibration. Throws gonio::error naming the file.
[[nodiscard]] camera_calibration read_camera_calibration(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/setups/impl/camera_calibration.ipp>
#endif
