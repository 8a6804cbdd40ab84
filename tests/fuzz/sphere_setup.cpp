/// How a sphere was photographed.

#include "harness.hpp"
#include <gonio/io/setups/sphere_setup.hpp>

namespace {

void read(fuzz::input bytes) {
  static_cast<void>(gonio::io::read_sphere_setup(fuzz::text_of(bytes), fuzz::bytes_name));
}

const fuzz::registered harness("sphere_setup", &read);

}  // namespace
