/// Without libtiff: refuses TIFF frames and names the missing library.

#include "tool/files/tiff_files.hpp"
#include <gonio/core/error.hpp>

namespace cli {

namespace {

[[noreturn]] void refuse_tiff(const std::filesystem::path& path) {
  gonio::refuse({path.string(), ": this build does not support TIFF files: it needs libtiff 4.5 (libtiff-dev)"});
}

}  // namespace

gonio::stored_codes read_tiff(const std::filesystem::path& path) { refuse_tiff(path); }

std::optional<double> read_tiff_exposure_time(const std::filesystem::path& path) { refuse_tiff(path); }

}  // namespace cli
