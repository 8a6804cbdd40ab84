#include "cli/exr_files.hpp"
#include <gonio/io/exr.hpp>

namespace cli {

gonio::image read_exr(const std::filesystem::path& path) { return gonio::io::read_exr(path); }

void write_exr(const std::filesystem::path& path, const gonio::image& picture) { gonio::io::write_exr(path, picture); }

}  // namespace cli
