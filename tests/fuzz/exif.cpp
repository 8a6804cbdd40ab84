/// EXIF data of JPEG files.

#include "harness.hpp"
#include <gonio/io/images/exif.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_exif_exposure_time(bytes, fuzz::bytes_name)); }

const fuzz::registered harness("exif", &read);

}  // namespace
