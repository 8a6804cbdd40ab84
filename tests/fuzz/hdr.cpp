/// Radiance HDR images.

#include "harness.hpp"
#include <gonio/io/images/image.hpp>

namespace {

void read(fuzz::input bytes) {
  const fuzz::memory_file file(bytes);
  static_cast<void>(gonio::io::read_hdr(file.path()));
}

const fuzz::registered harness("hdr", &read);

}  // namespace
