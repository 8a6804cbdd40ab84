/// MERL tables, plain or gzip.

#include "harness.hpp"
#include <gonio/io/materials/merl_gzip.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_merl_any(bytes, fuzz::bytes_name)); }

const fuzz::registered harness("merl", &read);

}  // namespace
