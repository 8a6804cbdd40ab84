/// How a near-field image was taken.

#include "harness.hpp"
#include <gonio/io/setups/near_field_setup.hpp>

namespace {

void read(fuzz::input bytes) {
  static_cast<void>(gonio::io::read_near_field_setup(fuzz::text_of(bytes), fuzz::bytes_name));
}

const fuzz::registered harness("near_field_setup", &read);

}  // namespace
