/// Spectral samples.

#include "harness.hpp"
#include <gonio/io/measurements/cornell.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_cornell(fuzz::text_of(bytes), fuzz::bytes_name)); }

const fuzz::registered harness("cornell", &read);

}  // namespace
