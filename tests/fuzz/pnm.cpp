/// Netpbm images of counts.

#include "harness.hpp"
#include <gonio/io/images/pnm.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_pnm(bytes, fuzz::bytes_name)); }

const fuzz::registered harness("pnm", &read);

}  // namespace
