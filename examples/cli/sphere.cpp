/// gonio sphere: photographs of a sphere, or of another surface whose normals are known, as measurements.

#include "command_line/fixed.hpp"
#include "commands.hpp"
#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/sphere_outline.hpp>
#include <gonio/capture/surface_photograph.hpp>
#include <gonio/io/camera_calibration.hpp>
#include <gonio/io/image.hpp>
#include <gonio/io/npy.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/io/sphere_setup.hpp>

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
  std::vector<std::pair<std::string, std::string>> photographs;  ///< each with its set-up
  std::vector<std::filesystem::path> white;
  std::filesystem::path calibration, normals, positions, output;
  bool fixed = false;
};

/// A photograph and how it was taken.
struct taken_photograph {
  std::string file, setup_file;
  gonio::image pixels;
  gonio::io::sphere_setup setup;
  std::optional<gonio::capture::white_reference> white;
};

/// Calls what knows nothing of files, and names them where that refuses something.
template <class Act>
auto naming_files(const taken_photograph& taken, Act&& act) {
  try {
    return act();
  } catch (const gonio::error& refusal) {
    gonio::refuse(taken.file + " (as " + taken.setup_file + " says): " + refusal.what());
  }
}

/// The white image that belongs to photograph number `i`, by what its set-up says.
std::optional<gonio::capture::white_reference> read_white(const sphere_command& options, std::size_t i,
                                                          const gonio::io::sphere_setup& setup) {
  const std::string& file = options.photographs[i].second;
  if (!setup.white_reflectance) {
    if (options.white.empty()) return {};
    gonio::refuse(file + ": --white needs 'white_reflectance', the reflectance of what the white image shows");
  }
  if (options.white.empty()) gonio::refuse(file + ": 'white_reflectance' needs a white image: give --white");
  gonio::capture::white_reference white{gonio::io::read_hdr(options.white[i]), *setup.white_reflectance, {}};
  if (setup.white_plane) white.surface = gonio::capture::surface_of(*setup.white_plane, setup.camera);
  return white;
}

std::vector<taken_photograph> read_photographs(const sphere_command& options) {
  if (!options.white.empty() && options.white.size() != options.photographs.size())
    gonio::refuse("--white needs an image for each photograph, " + std::to_string(options.photographs.size()) +
                  ", not " + std::to_string(options.white.size()));
  std::optional<gonio::io::camera_calibration> calibration;
  if (!options.calibration.empty()) calibration = gonio::io::read_camera_calibration(options.calibration);
  std::vector<taken_photograph> taken;
  for (std::size_t i = 0; i < options.photographs.size(); ++i) {
    const auto& [file, setup_file] = options.photographs[i];
    if (setup_file.empty()) gonio::refuse("photographs: " + file + " needs its set-up as the next argument");
    gonio::io::sphere_setup setup = gonio::io::read_sphere_setup(setup_file, calibration);
    if (options.normals.empty() && !setup.radius)
      gonio::refuse(setup_file + ": 'sphere' is missing, or give --normals");
    if (!options.normals.empty() && setup.radius)
      gonio::refuse(setup_file + ": 'sphere' and --normals say both what the surface is, give only one of them");
    auto white = read_white(options, i, setup);
    taken.push_back({file, setup_file, gonio::io::read_hdr(file), std::move(setup), std::move(white)});
  }
  return taken;
}

/// Where the sphere of one photograph is: said by the set-up, drawn by hand, or found; the last two are printed.
gonio::capture::fitted_outline sphere_of(const taken_photograph& taken) {
  const gonio::io::sphere_setup& setup = taken.setup;
  if (setup.centre) return {{*setup.centre, *setup.radius}};
  // A white reference of the same shape and place has the clearer outline: it has no highlight at grazing angles.
  const bool has_white_sphere = taken.white && !taken.white->surface;
  const gonio::image& outlined = has_white_sphere ? taken.white->photograph : taken.pixels;
  return naming_files(taken, [&] {
    return setup.outline ? gonio::capture::sphere_within(*setup.outline, setup.camera, *setup.radius)
                         : gonio::capture::find_sphere(outlined, setup.camera, *setup.radius, {.light = setup.light});
  });
}

void require_fixed(const std::vector<taken_photograph>& taken) {
  const gonio::io::sphere_setup& first = taken.front().setup;
  for (const taken_photograph& each : taken)
    if (each.setup.radius != first.radius || each.setup.camera.position() != first.camera.position() ||
        each.setup.camera.pinhole().rotation() != first.camera.pinhole().rotation())
      gonio::refuse(each.setup_file +
                    ": --fixed needs the same camera and sphere in all set-ups, and these differ from " +
                    taken.front().setup_file);
}

/// The sphere of each photograph; with --fixed the one that has the most of its outline, for all. It is no error there
/// if another shows too little of it.
std::vector<gonio::capture::fitted_outline> spheres_of(const std::vector<taken_photograph>& taken, bool fixed) {
  std::vector<gonio::capture::fitted_outline> all;
  if (!fixed) {
    for (const taken_photograph& each : taken) all.push_back(sphere_of(each));
    return all;
  }
  require_fixed(taken);
  std::optional<gonio::capture::fitted_outline> best;
  std::string why;
  for (const taken_photograph& each : taken) try {
      const gonio::capture::fitted_outline found = sphere_of(each);
      if (!best || found.inliers > best->inliers) best = found;
    } catch (const gonio::error& refusal) {
      why = refusal.what();
    }
  if (!best) gonio::refuse(why);
  return std::vector(taken.size(), *best);
}

/// The surface of each photograph, and what is to be said of it.
using known_surfaces = std::vector<std::pair<gonio::surface_image, std::string>>;

known_surfaces surfaces_of(const std::vector<taken_photograph>& taken, const sphere_command& options) {
  known_surfaces all;
  if (!options.normals.empty()) {
    const auto normals = gonio::io::read_npy<float, 3>(options.normals);
    std::optional<gonio::capture::vector_map> positions;
    if (!options.positions.empty()) positions = gonio::io::read_npy<float, 3>(options.positions);
    for (const taken_photograph& each : taken)
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
             fixed(found.sphere.centre.z(), 4) + ", outline met to " + fixed(found.deviation, 2) + " pixels";
    all.emplace_back(
        naming_files(taken[i], [&] { return gonio::capture::surface_of(found.sphere, taken[i].setup.camera); }),
        std::move(said));
  }
  return all;
}

/// Nothing where no cell has enough pixels to tell.
std::string noise_of(const gonio::capture::photograph_samples& found) {
  const double noise = 100.0 * found.pixel_deviation.mean();
  return noise > 0.0 ? ", noise of a pixel about " + fixed(noise, 1) + " %" : "";
}

void run(const sphere_command& options) {
  if (!options.positions.empty() && options.normals.empty()) gonio::refuse("--positions requires --normals");
  if (options.fixed && !options.normals.empty()) gonio::refuse("--fixed is of a sphere, not of --normals");
  const std::vector<taken_photograph> taken = read_photographs(options);
  const known_surfaces surfaces = surfaces_of(taken, options);
  gonio::sample_set samples;
  std::string lines;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const taken_photograph& each = taken[i];
    const auto found = naming_files(each, [&] {
      return gonio::capture::samples_of(each.pixels, surfaces[i].first, each.setup.camera, each.setup.light, each.white,
                                        each.setup.options);
    });
    samples.insert(samples.end(), found.samples.begin(), found.samples.end());
    lines += each.file + ": " + std::to_string(found.samples.size()) + " samples of " + std::to_string(found.pixels) +
             " pixels" + noise_of(found) + surfaces[i].second + '\n';
  }
  gonio::io::write_samples(options.output, samples);
  std::cout << lines;
}

}  // namespace

void add_sphere(command& app) {
  auto command = app.add_subcommand("sphere", "Turn photographs of a sphere into samples for gonio reconstruct");
  const auto options = std::make_shared<sphere_command>();
  command
      .add_input(
          "photographs", options->photographs,
          "Images of linear radiance (.hdr), each followed by its set-up (docs/reference/formats.md): camera, "
          "light and sphere, which is found by its outline (in the white image, if it shows a sphere) unless the "
          "set-up says where it is")
      .type_name("IMAGE SETUP")
      .required();
  command.add_input("--white", options->white,
                    "A white image (.hdr) for each photograph: a white reference under the same lamp and camera, so "
                    "that vignetting and the lamp's falloff cancel");
  command.add_input("--calibration", options->calibration,
                    "Camera and lens distortion as OpenCV writes them (.yml or .xml), instead of those in the set-ups");
  command.add_flag("--fixed", options->fixed,
                   "Camera and sphere are the same in all photographs: the sphere is found in the one that shows the "
                   "most of its outline");
  command.add_input("--normals", options->normals,
                    "Another surface than a sphere: the normals that the pixels see, in the camera's world, zero where "
                    "nothing is seen (.npy of rows x columns x 3)");
  command.add_input("--positions", options->positions,
                    "The places that the pixels see, which a lamp at a finite distance needs (with --normals; .npy)");
  command.add_output("-o,--output", options->output, {".csv"}, "Samples to write (.csv)").required();
  command.callback([options] { run(*options); });
}

}  // namespace cli
