/// Networks: their names, a zero byte, and the array.

#include "harness.hpp"
#include <gonio/io/materials/networks.hpp>

namespace {

void read(fuzz::input bytes) {
  const std::size_t end = std::min(fuzz::text_of(bytes).find(char{0}), bytes.size());
  const fuzz::memory_file names(bytes.first(end)), rows(bytes.subspan(std::min(end + 1, bytes.size())));
  static_cast<void>(gonio::io::read_names(names.path()));
  static_cast<void>(gonio::io::read_networks(rows.path(), names.path()));
}

const fuzz::registered harness("networks", &read);

}  // namespace
