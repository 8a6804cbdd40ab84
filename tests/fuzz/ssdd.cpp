/// Surface scattering distribution data.

#include "harness.hpp"
#include <gonio/io/ssdd.hpp>

namespace {

void read(fuzz::input bytes) { fuzz::read_both(bytes, gonio::io::parse_ssdd, gonio::io::parse_ssdd_spectra); }

const fuzz::registered harness("ssdd", &read);

}  // namespace
