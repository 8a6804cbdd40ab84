#pragma once
/// Bodies of io/setups/near_field_setup.hpp.

#include <gonio/capture/near_field_image.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/setups/near_field_setup.hpp>
#include <gonio/io/setups/setup_text.hpp>
#include <gonio/io/text/text.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io::detail {

inline constexpr auto near_field_entries =
    with_photograph_entries(std::array<setup_entry, 3>{{{"region", 1, 3}, {"window", 4}, {"block", 1}}});

GONIO_INLINE capture::near_field_setup make_setup(const setup_text& text,
                                                  const std::optional<camera_calibration>& calibration) {
  capture::near_field_setup setup{.camera = setup_camera(text, calibration), .light = setup_light(text)};
  text.require({"region", "window"});
  if (text.has("region")) {
    const auto& region = text.numbers("region");
    setup.disc = capture::sample_disc{region[0]};
    if (region.size() == 3) setup.disc->centre = {region[1], region[2]};
  }
  if (text.has("window"))
    setup.window = capture::pixel_window{text.count("window", 0, 0), text.count("window", 1, 0),
                                         text.count("window", 2, 1), text.count("window", 3, 1)};
  if (text.has("saturation")) setup.saturation = text.numbers("saturation")[0];
  if (text.has("block")) setup.block = text.count("block", 0, 1);
  const white_entries white = setup_white(text);
  setup.white_reflectance = white.reflectance;
  setup.white_plane = white.plane;
  return setup;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE capture::near_field_setup read_near_field_setup(std::string_view text, const std::string& name,
                                                             const std::optional<camera_calibration>& calibration) {
  const detail::setup_text entries(text, name, detail::near_field_entries);
  capture::near_field_setup setup = detail::make_setup(entries, calibration);
  entries.naming_file([&] { require_usable(setup); });
  return setup;
}

GONIO_INLINE capture::near_field_setup read_near_field_setup(const std::filesystem::path& path,
                                                             const std::optional<camera_calibration>& calibration) {
  const auto bytes = read_bytes(path);
  return read_near_field_setup(as_text(bytes), path.string(), calibration);
}

}  // namespace gonio::io
