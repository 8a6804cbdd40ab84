/// Measured BSDFs of MDL; what is read can be written and read again.

#include "harness.hpp"
#include <gonio/io/materials/mbsdf.hpp>

namespace {

void read(fuzz::input bytes) {
  gonio::io::mbsdf_material material = gonio::io::read_mbsdf(bytes, fuzz::bytes_name);
  const gonio::direction wi(0.6, 0.0, 0.8), wo(0.0, -0.28, 0.96);
  if (!material.reflection(wi, wo).allFinite()) throw std::runtime_error("a value is not finite");
  material.metadata.clear();  // its keys may be no words
  static_cast<void>(gonio::io::read_mbsdf(gonio::io::write_mbsdf(material), fuzz::bytes_name));
}

const fuzz::registered harness("mbsdf", &read);

}  // namespace
