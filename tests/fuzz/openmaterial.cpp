/// Tables of ASAM OpenMATERIAL 3D.

#include "harness.hpp"
#include <gonio/io/measurements/openmaterial.hpp>

namespace {

void read(fuzz::input bytes) {
  static_cast<void>(gonio::io::looks_like_openmaterial(fuzz::text_of(bytes)));
  static_cast<void>(gonio::io::read_openmaterial(fuzz::text_of(bytes), fuzz::bytes_name));
}

const fuzz::registered harness("openmaterial", &read);

}  // namespace
