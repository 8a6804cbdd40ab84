/// Without libexif: refuses EXIF data and names the missing library.

#include "tool/files/exif_files.hpp"
#include <gonio/core/error.hpp>

namespace cli {

std::optional<double> read_exif_exposure_time(const std::filesystem::path& path) {
  gonio::refuse({path.string(), ": this build cannot read EXIF data: it needs libexif (libexif-dev)"});
}

}  // namespace cli
