#include "photograph_files.hpp"

#include "radiance_image.hpp"

namespace cli {

void add_photograph_options(command& to, photograph_files& files, const std::string& name,
                            const std::string& described) {
  to.add_input(name, files.photographs, described).type_name("IMAGE SETUP").required();
  to.add_input("--white", files.white,
               "White image (" + radiance_formats() +
                   ") for each photograph, of a white reference with the same light and camera: cancels vignetting and "
                   "the lamp's falloff");
  to.add_input("--calibration", files.calibration,
               "Camera and lens distortion from OpenCV (.yml or .xml), instead of those in the set-ups");
}

std::optional<gonio::capture::white_reference> read_white(const photograph_files& files, std::size_t i,
                                                          const std::optional<double>& reflectance,
                                                          const std::optional<gonio::capture::placed_plane>& plane,
                                                          const gonio::lens_camera& camera) {
  const std::string& setup_file = files.photographs[i].second;
  if (!reflectance) {
    if (files.white.empty()) return {};
    gonio::refuse(setup_file + ": --white needs 'white_reflectance', the reflectance of the white reference");
  }
  if (files.white.empty()) gonio::refuse(setup_file + ": 'white_reflectance' needs --white");
  gonio::capture::white_reference white{read_radiance(files.white[i]), *reflectance, {}};
  if (plane) white.surface = gonio::capture::surface_of(*plane, camera);
  return white;
}

}  // namespace cli
