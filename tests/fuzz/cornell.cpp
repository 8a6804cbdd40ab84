/// Spectral samples.

#include "harness.hpp"
#include <gonio/io/measurements/cornell.hpp>

namespace {

void read(fuzz::input bytes) { fuzz::read_both(bytes, gonio::io::read_cornell, gonio::io::read_cornell_spectra); }

const fuzz::registered harness("cornell", &read);

}  // namespace
