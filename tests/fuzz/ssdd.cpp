/// Surface scattering distribution data.

#include "harness.hpp"
#include <gonio/io/measurements/ssdd.hpp>

namespace {

void read(fuzz::input bytes) { fuzz::read_both(bytes, gonio::io::read_ssdd, gonio::io::read_ssdd_spectra); }

const fuzz::registered harness("ssdd", &read);

}  // namespace
