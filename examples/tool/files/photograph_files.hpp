#pragma once
/// Photographs with their set-ups and white images: the options that `gonio sphere` and `gonio near-field` share.

#include "radiance_image.hpp"
#include "tool/options/command.hpp"
#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/surface_light.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/setups/camera_calibration.hpp>
#include <gonio/table/image.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cli {

/// The files given on the command line.
struct photograph_files {
  std::vector<std::pair<std::string, std::string>> photographs;  ///< each with its set-up
  std::vector<std::filesystem::path> white;
  std::filesystem::path calibration;
};

/// Adds the photographs as arguments, `--white` and `--calibration`. `described` is the help of the arguments.
void add_photograph_options(command& to, photograph_files& files, const std::string& name,
                            const std::string& described);

/// A photograph and its set-up.
template <class Setup>
struct taken_photograph {
  std::string file, setup_file;
  gonio::image pixels;
  Setup setup;
  std::optional<gonio::capture::white_reference> white;

  /// Calls `act` and adds the files' names to its errors.
  template <class Act>
  auto naming_files(Act&& act) const {
    try {
      return act();
    } catch (const gonio::error& refusal) {
      gonio::refuse({file, " (set-up ", setup_file, "): ", refusal.what()});
    }
  }
};

/// Returns the white image of photograph `i`, counted from 0; nothing without --white. Throws gonio::error if the
/// set-up has a white reflectance without --white, or the reverse.
[[nodiscard]] std::optional<gonio::capture::white_reference> read_white(
    const photograph_files& files, std::size_t i, const std::optional<double>& reflectance,
    const std::optional<gonio::capture::placed_plane>& plane, const gonio::lens_camera& camera);

/// Reads all photographs; `read_setup(path, calibration)` reads a set-up.
template <class ReadSetup>
[[nodiscard]] auto read_photographs(const photograph_files& files, const ReadSetup& read_setup) {
  if (!files.white.empty() && files.white.size() != files.photographs.size())
    gonio::refuse(
        {"--white needs an image for each photograph: ", files.photographs.size(), ", not ", files.white.size()});
  std::optional<gonio::io::camera_calibration> calibration;
  if (!files.calibration.empty()) calibration = gonio::io::read_camera_calibration(files.calibration);
  using setup_type = decltype(read_setup(std::string(), calibration));
  std::vector<taken_photograph<setup_type>> taken;
  for (std::size_t i = 0; i < files.photographs.size(); ++i) {
    const auto& [file, setup_file] = files.photographs[i];
    if (setup_file.empty()) gonio::refuse(file + " needs its set-up as the next argument");
    setup_type setup = read_setup(setup_file, calibration);
    auto white = read_white(files, i, setup.white_reflectance, setup.white_plane, setup.camera);
    taken.push_back({file, setup_file, read_radiance(file), std::move(setup), std::move(white)});
  }
  return taken;
}

}  // namespace cli
