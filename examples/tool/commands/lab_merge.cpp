/// gonio lab photograph, gonio lab merge: photographs a scene at several exposure times, and merges such photographs to
/// a radiance image.

#include "lab.hpp"
#include "lab/photographs.hpp"
#include "tool/files/exr_files.hpp"
#include "tool/files/frame_files.hpp"
#include "tool/files/radiance_image.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/warning.hpp"
#include <gonio/capture/merged_frames.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/images/pnm.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

namespace cli {

namespace {

using gonio::capture::value_state;

struct photograph_command {
  std::filesystem::path scene, output;
  std::vector<double> times{0.0001, 0.0004, 0.0016, 0.0064, 0.0256, 0.1024, 0.4096};
  std::string camera = "linear";
  int dark_frames = 4;
  std::uint64_t seed = 1;
};

struct merge_command {
  std::filesystem::path frames, times, dark, output, deviation, mask;
  double gamma = 0.0, level = 0.0, saturation = 0.98;  ///< gamma 0: estimate the camera's response
  gonio::capture::merge_options merging{.noise = {.read = 1.6, .shot = 0.2, .relative = 0.0}};
};

lab::photograph_settings settings_of(const std::string& camera) {
  if (camera == "linear") return lab::photograph_settings::usual();
  const auto curve = camera == "gamma" ? lab::response_curve::gamma : lab::response_curve::s_shaped;
  lab::photograph_settings settings = lab::photograph_settings::usual(curve);
  // Cameras whose response is not linear have already subtracted the dark signal.
  settings.pedestal = settings.dark_current = settings.hot_pixels = 0.0;
  return settings;
}

/// Returns decimal text without an exponent.
std::string decimal(double seconds) {
  std::array<char, 400> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), seconds, std::chars_format::fixed).ptr;
  return {text.data(), end};
}

/// Writes a file for each frame; its name ends in the exposure time.
void write_frames(const std::filesystem::path& folder, std::span<const gonio::capture::exposed_frame> frames) {
  std::filesystem::create_directories(folder);
  int number = 0;
  for (const auto& [seconds, codes] : frames) {
    const std::string name = "frame" + std::to_string(100 + ++number).substr(1);
    gonio::io::write_pnm(folder / (name + "_" + decimal(seconds) + "s.ppm"), codes);
  }
}

void run(const photograph_command& options) {
  const gonio::image scene = read_radiance(options.scene);
  const lab::photograph_settings settings = settings_of(options.camera);
  write_frames(options.output / "light", lab::photograph_bracket(scene, options.times, settings, options.seed));
  if (options.camera == "linear" && options.dark_frames > 0) {
    const auto [shortest, longest] = std::ranges::minmax(options.times);
    const std::array<double, 2> times{shortest, longest};
    write_frames(options.output / "dark", lab::photograph_dark(scene.shape(0), scene.shape(1), times,
                                                               options.dark_frames, settings, options.seed));
  }
  // Write the image that merging should give, in the same unit.
  gonio::image truth = lab::through_lens(scene, settings);
  for (float& value : truth) value = static_cast<float>(lab::merged_unit(settings) * double{value});
  gonio::io::write_npy(options.output / "truth.npy", truth);
  const gonio::capture::sensor_noise noise = lab::noise_of(settings);
  std::cout << options.times.size() << " photographs; the camera's noise is --read-noise " << fixed(noise.read, 3)
            << " --shot-noise " << fixed(noise.shot, 4) << " --flicker " << fixed(noise.relative, 4) << '\n';
}

/// Returns each pixel's state as a colour: black is usable.
gonio::image mask_of(const gonio::capture::merged_frames& merged) {
  gonio::image mask = gonio::uniform_image(merged.radiance.shape(0), merged.radiance.shape(1));
  const std::array<gonio::rgb, 5> colours{gonio::rgb(0, 0, 0), gonio::rgb(0, 0, 1), gonio::rgb(1, 1, 0),
                                          gonio::rgb(0, 1, 0), gonio::rgb(1, 0, 0)};
  const std::size_t columns = mask.shape(1);
  for (std::size_t pixel = 0; pixel < mask.shape(0) * columns; ++pixel) {
    const auto state = static_cast<std::size_t>(merged.pixel_state(static_cast<Eigen::Index>(pixel)));
    gonio::set_pixel(mask, pixel / columns, pixel % columns, colours[state]);
  }
  return mask;
}

void report(const gonio::capture::merged_frames& merged, const gonio::capture::dark_signal& dark) {
  const std::size_t columns = merged.radiance.shape(1);
  std::cout << merged.states.size() / 3 << " pixels: " << merged.count(value_state::usable) << " usable, "
            << merged.count(value_state::dark) << " dark, " << merged.count(value_state::contradictory)
            << " contradictory, " << merged.count(value_state::hot) << " hot, " << merged.count(value_state::saturated)
            << " saturated\n";
  constexpr Eigen::Index one_in = 20;
  if (one_in * merged.count(value_state::contradictory) > std::ssize(merged.states) / 3)
    warn(
        "the exposures of many pixels contradict each other: --read-noise, --shot-noise or --flicker is too small, the "
        "response is wrong, or something moved");
  constexpr std::size_t most_named = 20;
  const auto& hot = dark.hot_pixels();
  for (std::size_t i = 0; i < std::min(hot.size(), most_named); ++i)
    std::cout << "hot pixel: row " << hot[i] / columns << ", column " << hot[i] % columns << '\n';
  if (hot.size() > most_named) std::cout << "and " << hot.size() - most_named << " more: --mask shows all\n";
}

void run(merge_command options) {
  // Read the frames and the dark signal.
  if (!options.dark.empty() && options.gamma != 1.0)
    gonio::refuse("--dark needs --gamma 1: dark frames can be subtracted only from a linear camera");
  const auto frames = read_frames(options.frames, options.times);
  gonio::capture::dark_signal dark(options.level);
  if (!options.dark.empty()) {
    const auto dark_frames = read_frames(options.dark, {});
    try {
      dark = gonio::capture::dark_signal(dark_frames);
    } catch (const gonio::error& refusal) {
      gonio::refuse({options.dark.string(), ": ", refusal.what()});
    }
  }
  // Merge them with the camera's response.
  const std::uint16_t largest = frames.front().codes.largest;
  options.merging.saturation = static_cast<std::uint16_t>(std::lround(options.saturation * largest));
  const auto merged = [&] {
    try {
      const auto known = gonio::capture::camera_response::power_law(gonio::capture::counts_above(largest, dark),
                                                                    options.gamma > 0.0 ? options.gamma : 1.0);
      const std::array<gonio::capture::camera_response, 3> responses =
          options.gamma > 0.0
              ? std::array{known, known, known}
              : gonio::capture::estimate_responses(frames, dark, {.saturation = options.merging.saturation});
      return gonio::capture::merge_frames(frames, responses, dark, options.merging);
    } catch (const gonio::error& refusal) {
      gonio::refuse({options.frames.string(), ": ", refusal.what()});
    }
  }();
  // Write the result.
  write_radiance(options.output, merged.radiance);
  if (!options.deviation.empty()) write_radiance(options.deviation, merged.deviation);
  if (!options.mask.empty()) gonio::io::write_png(options.mask, mask_of(merged));
  report(merged, dark);
}

}  // namespace

void add_lab_photograph(command& lab) {
  auto command = lab.add_subcommand("photograph", "Photograph a scene at several exposure times, and in the dark");
  const auto options = std::make_shared<photograph_command>();
  command
      .add_input("scene", options->scene,
                 "Image of the scene's radiance, in which white under a lamp is 1 / pi (" + radiance_formats() + ")")
      .required();
  command.add_option("--times", options->times, "Exposure times in seconds")
      .check(check::range(1e-6, 1000.0))
      .capture_default_str();
  command.add_option("--camera", options->camera, "Response of the camera")
      .check(check::one_of({"linear", "gamma", "s-shaped"}))
      .capture_default_str();
  command
      .add_option(
          "--dark-frames", options->dark_frames,
          "Number of dark frames of a linear camera: this many at the shortest time, and as many at the longest")
      .check(check::range(0, 100))
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of the noise").capture_default_str();
  command
      .add_output_folder("-o,--output", options->output, {"truth.npy"},
                         "Folder to write, with light/, dark/ and truth.npy")
      .required();
  command.callback([options] { run(*options); });
}

void add_lab_merge(command& lab) {
  auto command = lab.add_subcommand("merge", "Merge photographs of several exposure times to radiance");
  const auto options = std::make_shared<merge_command>();
  // Declare the input.
  command
      .add_input_folder("frames", options->frames, {".png", ".tif", ".tiff", ".ppm", ".pgm"},
                        "Folder of photographs of one scene (.png, .tif, .ppm or .pgm), with exposure times at the end "
                        "of their names or in EXIF data")
      .required();
  command.add_input("--times", options->times,
                    "Table of exposure times, if neither names nor EXIF data have them (.csv: file,seconds)");
  auto dark = command.add_input_folder("--dark", options->dark, {".png", ".tif", ".tiff", ".ppm", ".pgm"},
                                       "Folder of dark frames, with exposure times like the photographs");
  // Declare the known properties of the camera.
  command.add_option("--dark-level", options->level, "Dark level in counts, if there are no dark frames")
      .check(check::non_negative_number())
      .excludes(dark);
  command
      .add_option("--gamma", options->gamma,
                  "Known camera response: counts are the exposure to the power of 1/gamma (1: linear)")
      .check(check::positive_number());
  command.add_option("--saturation", options->saturation, "Saturation level, as a share of the largest count")
      .check(check::range(0.1, 1.0))
      .capture_default_str();
  command
      .add_option("--read-noise", options->merging.noise.read,
                  "Read noise of a linear camera: standard deviation in counts")
      .check(check::non_negative_number())
      .capture_default_str();
  command
      .add_option("--shot-noise", options->merging.noise.shot,
                  "Shot noise of a linear camera: variance in counts^2 per count of signal")
      .check(check::non_negative_number())
      .capture_default_str();
  command.add_option("--flicker", options->merging.noise.relative, "Relative standard deviation of each exposure")
      .check(check::non_negative_number())
      .capture_default_str();
  // Declare the output.
  command.add_output("--deviation", options->deviation, {".npy", ".exr"},
                     std::string("Standard deviations of the values to write (.npy") + (has_exr ? " or .exr)" : ")"));
  command.add_output("--mask", options->mask, {".png"},
                     "Image to write (.png) of the state of each pixel: usable is black, too dark is blue, "
                     "contradictory is yellow, hot is green, saturated is red");
  add_threads_option(command, options->merging.threads);
  command
      .add_output("-o,--output", options->output, {".hdr", ".npy", ".exr"},
                  "Radiance to write (" + radiance_formats() + ")")
      .required();
  command.callback([options] { run(*options); });
}

}  // namespace cli
