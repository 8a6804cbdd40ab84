/// Calibrations of cameras, as OpenCV writes them.

#include "harness.hpp"
#include <gonio/io/setups/camera_calibration.hpp>

namespace {

void read(fuzz::input bytes) {
  static_cast<void>(gonio::io::read_camera_calibration(fuzz::text_of(bytes), fuzz::bytes_name));
}

const fuzz::registered harness("camera_calibration", &read);

}  // namespace
