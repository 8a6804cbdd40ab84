/// Exports of J&C's RT-300S.

#include "harness.hpp"
#include <gonio/io/measurements/rt300s.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_rt300s(fuzz::text_of(bytes), fuzz::bytes_name)); }

const fuzz::registered harness("rt300s", &read);

}  // namespace
