#include "tool/files/exif_files.hpp"
#include <gonio/io/images/exif.hpp>

namespace cli {

std::optional<double> read_exif_exposure_time(const std::filesystem::path& path) {
  return gonio::io::read_exif_exposure_time(path);
}

}  // namespace cli
