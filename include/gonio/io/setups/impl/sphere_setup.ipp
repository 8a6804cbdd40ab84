#pragma once
/// Bodies of io/setups/sphere_setup.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/setups/setup_text.hpp>
#include <gonio/io/setups/sphere_setup.hpp>
#include <gonio/io/text/text.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io::detail {

inline constexpr auto sphere_setup_entries =
    with_photograph_entries(std::array<setup_entry, 3>{{{"sphere", 1, 4}, {"outline", 3}, {"smallest_cosine", 1}}});

/// Reads the sphere's radius, centre and outline if the file gives them.
GONIO_INLINE void read_sphere(const setup_text& text, sphere_setup& setup) {
  if (text.has("outline") && !text.has("sphere")) text.refuse("outline", "needs 'sphere' with the sphere's radius");
  if (!text.has("sphere")) return;
  const auto& sphere = text.numbers("sphere");
  if (!(sphere[0] > 0.0)) text.refuse("sphere", "the radius must be positive, not " + shortest(sphere[0]));
  setup.radius = sphere[0];
  if (sphere.size() == 4) setup.centre = Eigen::Vector3d(sphere[1], sphere[2], sphere[3]);
  if (!text.has("outline")) return;
  if (setup.centre) text.refuse("outline", "'sphere' already states the centre, give only one of them");
  const auto& circle = text.numbers("outline");
  if (!(circle[2] > 0.0)) text.refuse("outline", "the radius must be positive, not " + shortest(circle[2]));
  setup.outline = {circle[0], circle[1], circle[2]};
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE sphere_setup read_sphere_setup(std::string_view text, const std::string& name,
                                            const std::optional<camera_calibration>& calibration) {
  const detail::setup_text entries(text, name, detail::sphere_setup_entries);
  sphere_setup setup{.camera = detail::setup_camera(entries, calibration), .light = detail::setup_light(entries)};
  detail::read_sphere(entries, setup);
  const detail::white_entries white = detail::setup_white(entries);
  setup.white_reflectance = white.reflectance;
  setup.white_plane = white.plane;
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
  return read_sphere_setup(as_text(bytes), path.string(), calibration);
}

}  // namespace gonio::io
