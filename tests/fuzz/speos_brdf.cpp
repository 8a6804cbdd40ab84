/// Text files of Speos.

#include "harness.hpp"
#include <gonio/io/measurements/speos_brdf.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_speos_brdf(fuzz::text_of(bytes), fuzz::bytes_name)); }

const fuzz::registered harness("speos_brdf", &read);

}  // namespace
