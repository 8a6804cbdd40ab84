/// Spectral samples.

#include "harness.hpp"
#include <gonio/io/cornell.hpp>

namespace {

void read(fuzz::input bytes) { fuzz::read_both(bytes, gonio::io::parse_cornell, gonio::io::parse_cornell_spectra); }

const fuzz::registered harness("cornell", &read);

}  // namespace
