/// ALTA's text format.

#include "harness.hpp"
#include <gonio/io/measurements/alta.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_alta(fuzz::text_of(bytes), fuzz::bytes_name)); }

const fuzz::registered harness("alta", &read);

}  // namespace
