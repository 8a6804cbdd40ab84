/// Tabulated BSDF of FRED.

#include "harness.hpp"
#include <gonio/io/measurements/fred_bsdf.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_fred_bsdf(fuzz::text_of(bytes), fuzz::bytes_name)); }

const fuzz::registered harness("fred_bsdf", &read);

}  // namespace
