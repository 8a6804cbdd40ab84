/// Tensor trees in XML.

#include "harness.hpp"
#include <gonio/io/measurements/tensor_tree_xml.hpp>

namespace {

void read(fuzz::input bytes) {
  static_cast<void>(gonio::io::read_tensor_tree_xml(fuzz::text_of(bytes), fuzz::bytes_name));
}

const fuzz::registered harness("tensor_tree_xml", &read);

}  // namespace
