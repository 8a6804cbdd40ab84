#include "tool/files/tiff_files.hpp"
#include <gonio/io/images/tiff.hpp>

namespace cli {

gonio::stored_codes read_tiff(const std::filesystem::path& path) { return gonio::io::read_tiff(path); }

std::optional<double> read_tiff_exposure_time(const std::filesystem::path& path) {
  return gonio::io::read_tiff_exposure_time(path);
}

}  // namespace cli
