/// Surface scattering distribution data.

#include "harness.hpp"
#include <gonio/io/measurements/ssdd.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_ssdd(fuzz::text_of(bytes), fuzz::bytes_name)); }

const fuzz::registered harness("ssdd", &read);

}  // namespace
