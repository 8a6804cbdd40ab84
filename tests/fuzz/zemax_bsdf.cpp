/// Zemax's tabular BSDF.

#include "harness.hpp"
#include <gonio/io/measurements/zemax_bsdf.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_zemax_bsdf(fuzz::text_of(bytes), fuzz::bytes_name)); }

const fuzz::registered harness("zemax_bsdf", &read);

}  // namespace
