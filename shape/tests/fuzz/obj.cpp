/// Reads OBJ meshes.

#include "fuzz/harness.hpp"
#include <gonio/shape/io/mesh.hpp>

namespace {

void read(fuzz::input bytes) {
  const fuzz::memory_file file(bytes, ".obj");
  static_cast<void>(gonio::io::read_mesh(file.path()));
}

const fuzz::registered harness("obj", &read);

}  // namespace
