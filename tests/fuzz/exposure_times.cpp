/// Tables of exposure times.

#include "harness.hpp"
#include <gonio/io/images/exposure_times.hpp>

namespace {

void read(fuzz::input bytes) {
  const fuzz::memory_file file(bytes);
  static_cast<void>(gonio::io::read_exposure_times(file.path()));
}

const fuzz::registered harness("exposure_times", &read);

}  // namespace
