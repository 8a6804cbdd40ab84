/// BSDF files of LightTools.

#include "harness.hpp"
#include <gonio/io/measurements/lighttools_bsdf.hpp>

namespace {

void read(fuzz::input bytes) {
  static_cast<void>(gonio::io::read_lighttools_bsdf(fuzz::text_of(bytes), fuzz::bytes_name));
}

const fuzz::registered harness("lighttools_bsdf", &read);

}  // namespace
