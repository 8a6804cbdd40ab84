/// Samples as ASTM E1392 has them.

#include "harness.hpp"
#include <gonio/io/measurements/astm_e1392.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_astm_e1392(fuzz::text_of(bytes), fuzz::bytes_name)); }

const fuzz::registered harness("astm_e1392", &read);

}  // namespace
