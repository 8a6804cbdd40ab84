/// Files of the metrology institutes.

#include "harness.hpp"
#include <gonio/io/bird.hpp>

namespace {

void read(fuzz::input bytes) { fuzz::read_both(bytes, gonio::io::parse_bird, gonio::io::parse_bird_spectra); }

const fuzz::registered harness("bird", &read);

}  // namespace
