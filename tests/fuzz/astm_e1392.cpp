/// Samples as ASTM E1392 has them.

#include "harness.hpp"
#include <gonio/io/measurements/astm_e1392.hpp>

namespace {

void read(fuzz::input bytes) { fuzz::read_both(bytes, gonio::io::read_astm_e1392, gonio::io::read_astm_e1392_spectra); }

const fuzz::registered harness("astm_e1392", &read);

}  // namespace
