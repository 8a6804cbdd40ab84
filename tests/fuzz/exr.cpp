/// OpenEXR images.

#include "harness.hpp"
#include <gonio/io/exr.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::parse_exr(bytes, fuzz::bytes_name)); }

const fuzz::registered harness("exr", &read);

}  // namespace
