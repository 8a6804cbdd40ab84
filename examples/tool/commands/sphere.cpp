/// gonio sphere: converts photographs of a sphere, or of another surface with known normals, to measurements.

#include "commands.hpp"
#include "tool/files/photograph_files.hpp"
#include "tool/files/radiance_image.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/sphere_outline.hpp>
#include <gonio/capture/surface_photograph.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/setups/sphere_setup.hpp>

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cli {

namespace {

struct sphere_command {
  photograph_files files;
  std::filesystem::path normals, positions, output;
  bool fixed = false;
};

using sphere_photograph = taken_photograph<gonio::io::sphere_setup>;

std::vector<sphere_photograph> photographs_of(const sphere_command& options) {
  return read_photographs(options.files, [&](const std::string& file, const auto& calibration) {
    gonio::io::sphere_setup setup = gonio::io::read_sphere_setup(file, calibration);
    if (options.normals.empty() && !setup.radius) gonio::refuse(file + ": needs 'sphere' or the option --normals");
    if (!options.normals.empty() && setup.radius)
      gonio::refuse(file + ": 'sphere' and --normals exclude each other: give one of them");
    return setup;
  });
}

/// Returns the sphere of a photograph: from the set-up, from an outline drawn by hand, or found in the image.
gonio::capture::fitted_outline sphere_of(const sphere_photograph& taken) {
  const gonio::io::sphere_setup& setup = taken.setup;
  if (setup.centre) return {{*setup.centre, *setup.radius}};
  // A white sphere in the same place has the clearer outline, without highlights at grazing angles.
  const bool has_white_sphere = taken.white && !taken.white->surface;
  const gonio::image& outlined = has_white_sphere ? taken.white->photograph : taken.pixels;
  return taken.naming_files([&] {
    return setup.outline ? gonio::capture::sphere_within(*setup.outline, setup.camera, *setup.radius)
                         : gonio::capture::find_sphere(outlined, setup.camera, *setup.radius, {.light = setup.light});
  });
}

void require_fixed(const std::vector<sphere_photograph>& taken) {
  const gonio::io::sphere_setup& first = taken.front().setup;
  for (const sphere_photograph& each : taken)
    if (each.setup.radius != first.radius || each.setup.camera.position() != first.camera.position() ||
        each.setup.camera.pinhole().rotation() != first.camera.pinhole().rotation())
      gonio::refuse(each.setup_file +
                    ": --fixed needs the same camera and sphere in all set-ups, but they differ from " +
                    taken.front().setup_file);
}

/// Returns the sphere of each photograph. With --fixed, all get the sphere with the most complete outline; the other
/// photographs may show only a small part of their outlines.
std::vector<gonio::capture::fitted_outline> spheres_of(const std::vector<sphere_photograph>& taken, bool fixed) {
  std::vector<gonio::capture::fitted_outline> all;
  if (!fixed) {
    for (const sphere_photograph& each : taken) all.push_back(sphere_of(each));
    return all;
  }
  require_fixed(taken);
  return std::vector(taken.size(), gonio::capture::fullest_outline(
                                       std::ssize(taken), [&](Eigen::Index i) { return sphere_of(taken[i]); }));
}

/// The surface of each photograph, and a text to print about it.
using known_surfaces = std::vector<std::pair<gonio::surface_image, std::string>>;

known_surfaces surfaces_of(const std::vector<sphere_photograph>& taken, const sphere_command& options) {
  known_surfaces all;
  if (!options.normals.empty()) {
    const auto normals = gonio::io::read_npy<float, 3>(options.normals);
    std::optional<gonio::capture::vector_map> positions;
    if (!options.positions.empty()) positions = gonio::io::read_npy<float, 3>(options.positions);
    for (const sphere_photograph& each : taken)
      all.emplace_back(gonio::capture::surface_of_maps(normals, options.normals.string(), each.setup.camera, positions,
                                                       options.positions.string()),
                       "");
    return all;
  }
  const auto spheres = spheres_of(taken, options.fixed);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const gonio::capture::fitted_outline& found = spheres[i];
    std::string said;
    if (found.edge_points > 0)
      said = ", sphere at " + fixed(found.sphere.centre.x(), 4) + ' ' + fixed(found.sphere.centre.y(), 4) + ' ' +
             fixed(found.sphere.centre.z(), 4) + ", outline matched to " + fixed(found.deviation, 2) + " pixels";
    all.emplace_back(
        taken[i].naming_files([&] { return gonio::capture::surface_of(found.sphere, taken[i].setup.camera); }),
        std::move(said));
  }
  return all;
}

/// Returns the noise as text; an empty text if no cell has enough pixels.
std::string noise_of(const gonio::capture::photograph_samples& found) {
  const double noise = 100.0 * found.pixel_deviation.mean();
  return noise > 0.0 ? ", noise of a pixel about " + fixed(noise, 1) + " %" : "";
}

void run(const sphere_command& options) {
  if (!options.positions.empty() && options.normals.empty()) gonio::refuse("--positions needs --normals");
  if (options.fixed && !options.normals.empty()) gonio::refuse("--fixed is not available with --normals");
  const std::vector<sphere_photograph> taken = photographs_of(options);
  const known_surfaces surfaces = surfaces_of(taken, options);
  gonio::sample_set samples;
  std::string lines;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const sphere_photograph& each = taken[i];
    const auto found = each.naming_files([&] {
      return gonio::capture::samples_of(each.pixels, surfaces[i].first, each.setup.camera, each.setup.light, each.white,
                                        each.setup.options);
    });
    samples.insert(samples.end(), found.samples.begin(), found.samples.end());
    lines += each.file + ": " + counted(std::ssize(found.samples), "sample") + " of " + std::to_string(found.pixels) +
             " pixels" + noise_of(found) + surfaces[i].second + '\n';
  }
  gonio::io::write_samples(options.output, samples);
  std::cout << lines;
}

}  // namespace

void add_sphere(command& app) {
  auto command = app.add_subcommand("sphere", "Convert photographs of a sphere to samples for gonio reconstruct");
  const auto options = std::make_shared<sphere_command>();
  add_photograph_options(
      command, options->files, "photographs",
      "Images of linear radiance (" + radiance_formats() +
          "), each followed by its set-up (docs/reference/formats.md): camera, light and sphere. Without a centre, the "
          "sphere is found by its outline (of the white image, if it shows a sphere)");
  command.add_flag("--fixed", options->fixed,
                   "Use one sphere for all photographs, found in the one with the most complete outline. The camera "
                   "must be the same, too");
  command.add_input("--normals", options->normals,
                    "Normals of a surface other than a sphere, for each pixel, in world coordinates; zero outside it "
                    "(.npy, rows x columns x 3)");
  command.add_input(
      "--positions", options->positions,
      "With --normals: positions of the surface for each pixel, needed for a lamp at a finite distance (.npy)");
  command.add_output("-o,--output", options->output, {".csv"}, "Samples to write (.csv)").required();
  command.callback([options] { run(*options); });
}

}  // namespace cli
