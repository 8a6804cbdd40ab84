/// Materials of the RGL database, in RGB and in spectra; what is read of square tables can be written and read again.

#include "harness.hpp"
#include <gonio/io/materials/rgl.hpp>

namespace {

void read(fuzz::input bytes) {
  const gonio::io::rgl_material material = gonio::io::read_rgl(bytes, fuzz::bytes_name);
  static_cast<void>(gonio::io::read_rgl(gonio::io::write_rgl(material), fuzz::bytes_name));
}

const fuzz::registered harness("rgl", &read);

}  // namespace
