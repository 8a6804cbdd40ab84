/// What an apparatus cannot do.

#include "harness.hpp"
#include <gonio/io/setups/capture_constraint.hpp>

namespace {

void read(fuzz::input bytes) {
  static_cast<void>(gonio::io::read_capture_constraint(fuzz::text_of(bytes), fuzz::bytes_name));
}

const fuzz::registered harness("capture_constraint", &read);

}  // namespace
