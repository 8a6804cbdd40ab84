/// TIFF images of counts, and their exposure times.

#include "harness.hpp"
#include <gonio/io/images/tiff.hpp>

namespace {

void read(fuzz::input bytes) {
  static_cast<void>(gonio::io::read_tiff_exposure_time(bytes, fuzz::bytes_name));
  static_cast<void>(gonio::io::read_tiff(bytes, fuzz::bytes_name));
}

const fuzz::registered harness("tiff", &read);

}  // namespace
