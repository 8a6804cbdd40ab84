/// Klems matrices in XML.

#include "harness.hpp"
#include <gonio/io/measurements/klems_xml.hpp>

namespace {

void read(fuzz::input bytes) { static_cast<void>(gonio::io::read_klems_xml(fuzz::text_of(bytes), fuzz::bytes_name)); }

const fuzz::registered harness("klems_xml", &read);

}  // namespace
