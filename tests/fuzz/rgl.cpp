/// Materials of the RGL database.

#include "harness.hpp"
#include <gonio/io/rgl.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::parse_rgl(bytes, fuzz::bytes_name)); }

const fuzz::registered harness("rgl", &read);

}  // namespace
