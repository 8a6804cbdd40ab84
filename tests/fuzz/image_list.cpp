/// Lists of images of `gonio svbrdf`. The images themselves have harnesses of their own.

#include "harness.hpp"

#include <tool/files/image_list.hpp>

namespace {

void read(fuzz::input bytes) {
  const fuzz::memory_file file(bytes);
  static_cast<void>(cli::read_image_list(file.path()));
}

const fuzz::registered harness("image_list", &read);

}  // namespace
