/// Materials of the RGL database, in RGB and in spectra; what is read of square tables can be written and read again.

#include "harness.hpp"
#include <gonio/io/rgl.hpp>

namespace {

void read(fuzz::input bytes) {
  const gonio::io::rgl_material material = gonio::io::parse_rgl(bytes, fuzz::bytes_name);
  static_cast<void>(gonio::io::parse_rgl(gonio::io::serialise_rgl(material), fuzz::bytes_name));
}

const fuzz::registered harness("rgl", &read);

}  // namespace
