/// UTIA's BRDF database, with few directions.

#include "harness.hpp"
#include <gonio/io/materials/utia.hpp>

namespace {

void read(fuzz::input bytes) {
  static_cast<void>(gonio::io::read_utia(bytes, fuzz::bytes_name, {.polar = 2, .polar_step = 30.0, .azimuths = 3}));
}

const fuzz::registered harness("utia", &read);

}  // namespace
