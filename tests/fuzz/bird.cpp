/// Files of the metrology institutes.

#include "harness.hpp"
#include <gonio/io/measurements/bird.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_bird(fuzz::text_of(bytes), fuzz::bytes_name)); }

const fuzz::registered harness("bird", &read);

}  // namespace
