/// Without OpenEXR: refuses OpenEXR images and names the missing library.

#include "tool/files/exr_files.hpp"
#include <gonio/core/error.hpp>

namespace cli {

namespace {

[[noreturn]] void refuse_exr(const std::filesystem::path& path) {
  gonio::refuse({path.string(), ": this build does not support OpenEXR files: it needs OpenEXR (libopenexr-dev)"});
}

}  // namespace

const bool has_exr = false;

gonio::image read_exr(const std::filesystem::path& path) { refuse_exr(path); }

std::unique_ptr<image_rows> open_exr(const std::filesystem::path& path) { refuse_exr(path); }

void write_exr(const std::filesystem::path& path, const gonio::image&) { refuse_exr(path); }

}  // namespace cli
