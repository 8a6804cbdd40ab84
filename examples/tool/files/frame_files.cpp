#include "frame_files.hpp"

#include "exif_files.hpp"
#include "file_start.hpp"
#include "tiff_files.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/images/exposure_times.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/images/pnm.hpp>
#include <gonio/io/text/named_files.hpp>

#include <optional>
#include <string>

namespace cli {

namespace {

bool is_tiff(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".tif" || extension == ".tiff";
}

/// Returns the camera's exposure time in seconds, from the file or from a JPEG file of the same name beside it.
std::optional<double> seconds_of_camera(const std::filesystem::path& file) {
  if (is_tiff(file))
    if (const auto seconds = read_tiff_exposure_time(file)) return seconds;
  for (const char* extension : {".jpg", ".jpeg", ".JPG"}) {
    std::filesystem::path beside = file;
    beside.replace_extension(extension);
    if (std::filesystem::exists(beside)) return read_exif_exposure_time(beside);
  }
  return {};
}

double seconds_of(const gonio::io::named_file& file, const std::filesystem::path& table,
                  const gonio::io::exposure_times& times) {
  const std::string name = file.path.filename().string();
  if (!table.empty()) {
    const auto found = times.find(name);
    if (found == times.end()) gonio::refuse({table.string(), ": has no exposure time of '", name, "'"});
    return found->second;
  }
  try {
    if (const auto seconds = gonio::io::exposure_time_of_name(file.name)) return *seconds;
  } catch (const gonio::error& refusal) {
    gonio::refuse({file.path.string(), ": ", refusal.what(), " (or give --times)"});
  }
  if (const auto seconds = seconds_of_camera(file.path)) return *seconds;
  gonio::refuse(
      {file.path.string(),
       ": has no exposure time: it needs one at the end of its name, as frame_0.004s or frame_1_250s, or in EXIF data "
       "(of a TIFF file, or of a JPEG file beside it), or in a table given by --times (file,seconds)"});
}

gonio::stored_codes codes_of(const std::filesystem::path& file) {
  if (is_tiff(file)) return read_tiff(file);
  return lower_extension(file) == ".png" ? gonio::io::read_png_codes(file) : gonio::io::read_pnm(file);
}

void require_like_first(const gonio::stored_codes& codes, const std::filesystem::path& file,
                        const gonio::stored_codes& first, const std::filesystem::path& first_file) {
  if (codes.rows == first.rows && codes.columns == first.columns && codes.largest == first.largest) return;
  gonio::refuse({file.string(), ": has ", codes.columns, " x ", codes.rows, " pixels and counts up to ",
                 int{codes.largest}, ", but ", first_file.filename().string(), " has ", first.columns, " x ",
                 first.rows, " and counts up to ", int{first.largest}});
}

}  // namespace

std::vector<gonio::capture::exposed_frame> read_frames(const std::filesystem::path& folder,
                                                       const std::filesystem::path& times) {
  const auto files = gonio::io::list_named_files(folder, frame_extensions, "photograph");
  const auto table = times.empty() ? gonio::io::exposure_times{} : gonio::io::read_exposure_times(times);
  std::vector<gonio::capture::exposed_frame> frames;
  for (const gonio::io::named_file& file : files) {
    const double seconds = seconds_of(file, times, table);
    frames.push_back({seconds, codes_of(file.path)});
    require_like_first(frames.back().codes, file.path, frames.front().codes, files.front().path);
  }
  return frames;
}

}  // namespace cli
