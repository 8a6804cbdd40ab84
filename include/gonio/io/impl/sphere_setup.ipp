#pragma once
/// Bodies of io/sphere_setup.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/file.hpp>
#include <gonio/io/near_field_setup.hpp>
#include <gonio/io/sphere_setup.hpp>
#include <gonio/io/text.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io::detail {

inline constexpr std::array<setup_entry, 19> sphere_setup_entries{{{"size", 2},
                                                                   {"focal_length", 1, 2},
                                                                   {"field_of_view", 1},
                                                                   {"principal_point", 2},
                                                                   {"distortion", 4, 5},
                                                                   {"position", 3},
                                                                   {"target", 3},
                                                                   {"up", 3},
                                                                   {"rotation", 9},
                                                                   {"light", 3},
                                                                   {"irradiance", 1, 3},
                                                                   {"lamp", 3},
                                                                   {"intensity", 1, 3},
                                                                   {"sphere", 1, 4},
                                                                   {"outline", 3},
                                                                   {"white_reflectance", 1},
                                                                   {"white_plane", 6},
                                                                   {"saturation", 1},
                                                                   {"smallest_cosine", 1}}};

GONIO_INLINE camera_intrinsics sphere_intrinsics(const setup_text& text) {
  text.require({"focal_length", "field_of_view"});
  text.require_one_of("field_of_view", "focal_length", "how wide the lens is");
  if (text.has("focal_length")) return setup_intrinsics(text);
  const double angle = text.numbers("field_of_view")[0];
  if (!(angle > 0.0 && angle < 180.0))
    text.refuse("field_of_view", shortest(angle) + " degrees, expected above 0 and below 180");
  camera_intrinsics intrinsics;
  intrinsics.columns = text.count("size", 0, 1);
  intrinsics.rows = text.count("size", 1, 1);
  intrinsics.focal_length_x = 0.5 * static_cast<double>(intrinsics.columns) / std::tan(0.5 * radians(angle));
  intrinsics.focal_length_y = intrinsics.focal_length_x;
  set_principal_point(text, intrinsics);
  return intrinsics;
}

GONIO_INLINE lens_camera sphere_camera(const setup_text& text, const std::optional<camera_calibration>& calibration) {
  if (calibration) {
    for (const std::string_view entry : {"size", "focal_length", "field_of_view", "principal_point", "distortion"})
      if (text.has(entry)) text.refuse(entry, "the calibration says it already, give only one of them");
    const pinhole_camera pinhole = setup_camera(text, calibration->intrinsics);
    return text.naming_file([&] { return lens_camera(pinhole, calibration->distortion); });
  }
  const pinhole_camera pinhole = setup_camera(text, sphere_intrinsics(text));
  lens_distortion distortion;
  if (text.has("distortion")) {
    const auto& all = text.numbers("distortion");
    distortion = {.k1 = all[0], .k2 = all[1], .p1 = all[2], .p2 = all[3], .k3 = all.size() > 4 ? all[4] : 0.0};
  }
  return text.naming_file([&] { return lens_camera(pinhole, distortion); });
}

GONIO_INLINE capture::surface_light sphere_light(const setup_text& text) {
  text.require({"light", "lamp"});
  text.require_one_of("light", "lamp", "where the light is");
  if (text.has("light")) {
    if (text.has("intensity")) text.refuse("intensity", "is that of a lamp, of a distant light give irradiance");
    return setup_light(text);
  }
  if (text.has("irradiance")) text.refuse("irradiance", "is that of a distant light, of a lamp give intensity");
  capture::point_lamp lamp{text.vector("lamp")};
  if (text.has("intensity")) {
    const auto& values = text.numbers("intensity");
    lamp.intensity = values.size() == 1 ? rgb::Constant(values[0]) : rgb(values[0], values[1], values[2]);
    if (!(lamp.intensity > 0.0).all()) text.refuse("intensity", "must be positive in each channel");
  }
  return lamp;
}

/// Where the sphere is said to be.
GONIO_INLINE void read_sphere(const setup_text& text, sphere_setup& setup) {
  if (text.has("outline") && !text.has("sphere")) text.refuse("outline", "needs 'sphere', its radius");
  if (!text.has("sphere")) return;
  const auto& sphere = text.numbers("sphere");
  if (!(sphere[0] > 0.0)) text.refuse("sphere", "the radius must be positive, not " + shortest(sphere[0]));
  setup.radius = sphere[0];
  if (sphere.size() == 4) setup.centre = Eigen::Vector3d(sphere[1], sphere[2], sphere[3]);
  if (!text.has("outline")) return;
  if (setup.centre) text.refuse("outline", "'sphere' says already where the centre is, give only one of them");
  const auto& circle = text.numbers("outline");
  if (!(circle[2] > 0.0)) text.refuse("outline", "the radius must be positive, not " + shortest(circle[2]));
  setup.outline = {circle[0], circle[1], circle[2]};
}

/// What the white image shows.
GONIO_INLINE void read_white(const setup_text& text, sphere_setup& setup) {
  if (text.has("white_plane") && !text.has("white_reflectance"))
    text.refuse("white_plane", "needs 'white_reflectance'");
  if (!text.has("white_reflectance")) return;
  setup.white_reflectance = text.numbers("white_reflectance")[0];
  if (!(*setup.white_reflectance > 0.0 && *setup.white_reflectance <= 1.0))
    text.refuse("white_reflectance", shortest(*setup.white_reflectance) + ", expected above 0 and up to 1");
  if (!text.has("white_plane")) return;
  const auto& plane = text.numbers("white_plane");
  setup.white_plane = {{plane[0], plane[1], plane[2]}, {plane[3], plane[4], plane[5]}};
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE sphere_setup parse_sphere_setup(std::string_view text, const std::string& name,
                                             const std::optional<camera_calibration>& calibration) {
  const detail::setup_text entries(text, name, detail::sphere_setup_entries);
  sphere_setup setup{.camera = detail::sphere_camera(entries, calibration), .light = detail::sphere_light(entries)};
  detail::read_sphere(entries, setup);
  detail::read_white(entries, setup);
  if (entries.has("saturation")) {
    setup.options.saturation = entries.numbers("saturation")[0];
    if (!(*setup.options.saturation > 0.0)) entries.refuse("saturation", "must be positive");
  }
  if (entries.has("smallest_cosine")) {
    setup.options.smallest_cosine = entries.numbers("smallest_cosine")[0];
    if (!(setup.options.smallest_cosine > 0.0 && setup.options.smallest_cosine < 1.0))
      entries.refuse("smallest_cosine", "expected above 0 and below 1");
  }
  return setup;
}

GONIO_INLINE sphere_setup read_sphere_setup(const std::filesystem::path& path,
                                            const std::optional<camera_calibration>& calibration) {
  const auto bytes = read_bytes(path);
  return parse_sphere_setup(detail::as_text(bytes), path.string(), calibration);
}

}  // namespace gonio::io
