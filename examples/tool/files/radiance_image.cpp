#include "radiance_image.hpp"

#include "exr_files.hpp"
#include "file_start.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>

namespace cli {

std::string radiance_formats() { return has_exr ? ".hdr, .npy or .exr" : ".hdr or .npy"; }

std::string radiance_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".npy" || extension == ".exr" || extension == ".hdr") return extension;
  const std::string start = file_start(path);
  if (start.empty() || start.starts_with("#?"))
    return ".hdr";  // the reader gives the reason if there is nothing to read
  gonio::refuse({path.string(), ": is not an image of linear radiance (", radiance_formats(),
                 "); gonio lab merge makes one from photographs"});
}

gonio::image read_radiance(const std::filesystem::path& path) {
  const std::string format = radiance_format(path);
  if (format == ".exr") return read_exr(path);
  if (format == ".hdr") return gonio::io::read_hdr(path);
  gonio::image picture = gonio::io::read_npy<float, 3>(path);
  if (picture.shape(2) != 3)
    gonio::refuse({path.string(), ": has ", picture.shape(2), " values for each pixel, expected 3"});
  return picture;
}

void write_radiance(const std::filesystem::path& path, const gonio::image& picture) {
  const std::string extension = lower_extension(path);
  if (extension == ".npy") return gonio::io::write_npy(path, picture);
  if (extension == ".exr") return write_exr(path, picture);
  gonio::io::write_hdr(path, picture);
}

}  // namespace cli
