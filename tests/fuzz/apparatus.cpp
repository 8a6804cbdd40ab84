/// Descriptions of an apparatus.

#include "harness.hpp"
#include <gonio/io/setups/apparatus.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_apparatus(fuzz::text_of(bytes), fuzz::bytes_name)); }

const fuzz::registered harness("apparatus", &read);

}  // namespace
