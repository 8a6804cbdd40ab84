#include "tool/files/exr_files.hpp"
#include <gonio/io/images/exr.hpp>

namespace cli {

const bool has_exr = true;

gonio::image read_exr(const std::filesystem::path& path) { return gonio::io::read_exr(path); }

std::unique_ptr<image_rows> open_exr(const std::filesystem::path& path) {
  return std::make_unique<image_rows_of<gonio::io::exr_rows>>(path);
}

void write_exr(const std::filesystem::path& path, const gonio::image& picture) { gonio::io::write_exr(path, picture); }

}  // namespace cli
