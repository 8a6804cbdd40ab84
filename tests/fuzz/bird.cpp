/// Files of the metrology institutes.

#include "harness.hpp"
#include <gonio/io/measurements/bird.hpp>

namespace {

void read(fuzz::input bytes) { fuzz::read_both(bytes, gonio::io::read_bird, gonio::io::read_bird_spectra); }

const fuzz::registered harness("bird", &read);

}  // namespace
