/// gonio lab probe, gonio lab unwrap: images an environment in a mirror sphere, and unwraps such images.

#include "lab.hpp"
#include "lab/mirror_sphere_lab.hpp"
#include "tool/files/radiance_image.hpp"
#include "tool/options/number_list.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/capture/light_probe.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/render/image.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cli {

namespace {

using gonio::capture::light_probe;

struct probe_command {
  std::filesystem::path input, output;
  double distance = 0.0;  ///< in radii of the sphere; 0: infinite
  std::size_t pixels = 1024;
  double margin = 0.0, photographer = 0.0;
  std::string towards = "0,0";
};

struct unwrap_command {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output, truth, image;
  double distance = 0.0;
  std::vector<std::string> towards, outlines;
  std::optional<double> photographer;  ///< degrees
  gonio::capture::unwrap_options unwrapping;
  gonio::thread_count threads;
};

gonio::capture::mirror_sphere sphere_at(double distance) {
  return distance > 0.0 ? gonio::capture::mirror_sphere(distance) : gonio::capture::mirror_sphere();
}

/// Returns the axes of the camera of --towards AZIMUTH,ELEVATION[,ROLL].
Eigen::Matrix3d axes_of(const std::string& towards) {
  const auto numbers = numbers_in(towards, "--towards");
  if (numbers.size() != 2 && numbers.size() != 3)
    gonio::refuse({"--towards ", towards, ": expected AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,ROLL"});
  const double roll = numbers.size() == 3 ? numbers[2] : 0.0;
  return gonio::capture::camera_axes(gonio::radians(numbers[0]), gonio::radians(numbers[1]), gonio::radians(roll));
}

void photograph(const probe_command& options) {
  const gonio::render::environment_map around(read_radiance(options.input));
  const auto radiance = [&](const gonio::direction& towards) { return around(towards); };
  lab::probe_view view = lab::probe_view::square(options.pixels, options.margin);
  view.axes = axes_of(options.towards);
  view.photographer = gonio::radians(options.photographer);
  write_radiance(options.output, lab::photograph(sphere_at(options.distance), radiance, view));
}

/// Returns the outline of --outline in a photograph: found, given, or that of a sphere that fills the image.
gonio::capture::outline_circle outline_in(const gonio::image& photograph, const std::string& given,
                                          const std::filesystem::path& file) {
  if (given == "find") {
    const auto found = gonio::capture::find_outline(photograph);
    std::cout << file.string() << ": the sphere is at column " << fixed(found.column, 1) << ", row "
              << fixed(found.row, 1) << ", its radius is " << fixed(found.radius, 1) << " pixels\n";
    return found;
  }
  if (!given.empty()) {
    const auto numbers = numbers_in(given, "--outline");
    if (numbers.size() != 3) gonio::refuse({"--outline ", given, ": expected COLUMN,ROW,RADIUS or find"});
    return {numbers[0], numbers[1], numbers[2]};
  }
  if (photograph.shape(0) != photograph.shape(1))
    gonio::refuse({"an image that a mirror sphere fills must be square, not ", photograph.shape(0), " x ",
                   photograph.shape(1), "; --outline find finds a sphere with a margin"});
  return gonio::capture::filled_outline(photograph);
}

/// Returns the value for one of several images: their own, the only one, or nothing.
std::string value_for(std::size_t image, const std::vector<std::string>& given, std::size_t images,
                      const char* option) {
  if (given.empty()) return {};
  if (given.size() != 1 && given.size() != images)
    gonio::refuse({option, " needs one value for each of ", images, " images, not ", given.size()});
  return given.size() == 1 ? given.front() : given[image];
}

std::vector<light_probe> probes_of(const unwrap_command& options) {
  const std::size_t images = options.inputs.size();
  if (images > 1 && options.towards.size() != images)
    gonio::refuse({"several images need one --towards each: expected ", images, ", not ", options.towards.size()});
  constexpr double usual = 15.0;
  const double photographer = options.photographer.value_or(images > 1 ? usual : 0.0);
  std::vector<light_probe> probes;
  for (std::size_t i = 0; i < images; ++i) {
    const std::filesystem::path& file = options.inputs[i];
    light_probe probe{.photograph = read_radiance(file),
                      .sphere = sphere_at(options.distance),
                      .photographer = gonio::radians(photographer)};
    if (const std::string towards = value_for(i, options.towards, images, "--towards"); !towards.empty())
      probe.axes = axes_of(towards);
    const std::string outline = value_for(i, options.outlines, images, "--outline");
    try {
      probe.outline = outline_in(probe.photograph, outline, file);
      probe.require_usable();
    } catch (const gonio::error& refusal) {
      gonio::refuse({file.string(), ": ", refusal.what()});
    }
    probes.push_back(std::move(probe));
  }
  return probes;
}

/// Returns an image with fewer rows. Each pixel is the mean of the pixels that it replaces.
gonio::image averaged(const gonio::image& image, std::size_t rows, const std::filesystem::path& file) {
  const std::size_t factor = image.shape(0) / rows;
  if (factor * rows != image.shape(0) || image.shape(1) % factor != 0)
    gonio::refuse(file.string() + ": an image of " + std::to_string(image.shape(0)) + " rows and " +
                  std::to_string(image.shape(1)) + " columns cannot be averaged to one of " + std::to_string(rows) +
                  " rows");
  gonio::image means = gonio::uniform_image(rows, image.shape(1) / factor);
  for (std::size_t row = 0; row < image.shape(0); ++row)
    for (std::size_t column = 0; column < image.shape(1); ++column) {
      const gonio::rgb sum = gonio::pixel(means, row / factor, column / factor) +
                             gonio::pixel(image, row, column) / static_cast<double>(factor * factor);
      gonio::set_pixel(means, row / factor, column / factor, sum);
    }
  return means;
}

/// Returns the photographs beside the map, exposed so that the map's mean is middle grey; highlights are clipped.
gonio::image image_of(const std::vector<light_probe>& probes, const gonio::image& map, const unwrap_command& options) {
  std::vector<gonio::image> all;
  for (std::size_t i = 0; i < probes.size(); ++i)
    all.push_back(averaged(probes[i].photograph, map.shape(0), options.inputs[i]));
  all.push_back(map);
  gonio::image image = gonio::render::side_by_side(all, 4);
  const double mean = std::accumulate(map.data(), map.data() + map.size(), 0.0) / static_cast<double>(map.size());
  const auto exposure = static_cast<float>(mean > 0.0 ? 0.18 / mean : 1.0);
  std::transform(image.data(), image.data() + image.size(), image.data(),
                 [=](float value) { return exposure * value; });
  return image;
}

/// Whether a direction is more than 10 degrees from the part that the sphere hides in one of the photographs.
bool is_shown(const gonio::direction& towards, const std::vector<light_probe>& probes) {
  return std::ranges::any_of(probes, [&](const light_probe& probe) {
    return gonio::angle_between(towards, probe.axes.col(2)) <=
           probe.sphere.largest_polar_angle() - gonio::radians(10.0);
  });
}

/// Returns the mean relative error of a map, weighted by solid angle, over the directions that are shown. Pixels whose
/// truth is black are ignored.
double relative_error(const gonio::image& map, const gonio::render::environment_map& truth,
                      const std::vector<light_probe>& probes) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t row = 0; row < truth.rows(); ++row)
    for (std::size_t column = 0; column < truth.columns(); ++column) {
      const gonio::rgb expected = gonio::pixel(truth.image(), row, column);
      if (!is_shown(truth.towards(row, column), probes) || !(expected > 0.0).all()) continue;
      const gonio::rgb off = (gonio::pixel(map, row, column) - expected).abs() / expected;
      sum += truth.solid_angle(row) * off.mean();
      weights += truth.solid_angle(row);
    }
  return sum / weights;
}

void unwrap(const unwrap_command& options) {
  const std::vector<light_probe> probes = probes_of(options);
  const gonio::image map = gonio::capture::unwrap(probes, options.unwrapping, options.threads);
  write_radiance(options.output, map);
  if (!options.image.empty()) gonio::io::write_png(options.image, image_of(probes, map, options));
  if (options.truth.empty()) return;
  const gonio::render::environment_map truth(
      averaged(read_radiance(options.truth), options.unwrapping.rows, options.truth));
  std::cout << "mean relative error " << fixed(100.0 * relative_error(map, truth, probes), 2)
            << " %, except within 10 degrees of the part that the sphere hides"
            << (probes.size() > 1 ? " in all images\n" : "\n");
}

void add_distance_option(command& to, double& distance) {
  to.add_option("--distance", distance,
                "Distance from the sphere's centre to the camera, in radii of the sphere (default: infinite)")
      .check(check::range(1.001, 1e6));
}

constexpr const char* towards_help =
    "Direction from the sphere to the camera, AZIMUTH,ELEVATION[,ROLL] in degrees: azimuth 0 is the map's right edge "
    "and grows to the left, elevation grows upwards; roll turns the horizon of the image clockwise";

}  // namespace

void add_lab_probe(command& lab) {
  auto command = lab.add_subcommand("probe", "Photograph a mirror sphere in an environment");
  const auto options = std::make_shared<probe_command>();
  command
      .add_input("environment", options->input,
                 "Environment to photograph, latitude-longitude (" + radiance_formats() + ")")
      .required();
  add_distance_option(command, options->distance);
  command.add_option("--towards", options->towards, towards_help).capture_default_str();
  command.add_option("--margin", options->margin, "Margin around the sphere, in radii of the sphere")
      .check(check::range(0.0, 10.0))
      .capture_default_str();
  command
      .add_option("--photographer", options->photographer,
                  "Angle around the camera's direction that the photographer hides, in degrees")
      .check(check::range(0.0, 90.0))
      .capture_default_str();
  command.add_option("--size", options->pixels, "Rows and columns of the image")
      .check(check::range(8, 8192))
      .capture_default_str();
  command
      .add_output("-o,--output", options->output, {".hdr", ".npy", ".exr"},
                  "Square image of the sphere to write (" + radiance_formats() + ")")
      .required();
  command.callback([options] { photograph(*options); });
}

void add_lab_unwrap(command& lab) {
  auto command = lab.add_subcommand("unwrap", "Convert images of a mirror sphere to an environment map");
  const auto options = std::make_shared<unwrap_command>();
  // Declare the photographs.
  command
      .add_input("images", options->inputs,
                 "Images of the sphere, linear radiance (" + radiance_formats() +
                     "). Several from different directions are merged: the photographer and the seam vanish")
      .required();
  add_distance_option(command, options->distance);
  command.add_option("--towards", options->towards, std::string(towards_help) + ". One for each image (one image: 0,0)")
      .repeatable();
  command
      .add_option(
          "--outline", options->outlines,
          "Sphere in the image: COLUMN,ROW,RADIUS in pixels, or find, in front of a uniform background. One for "
          "all images or one for each (default: it fills a square image)")
      .repeatable();
  command
      .add_option("--photographer", options->photographer,
                  "Angle around the camera's direction that the photographer hides, in degrees. With several images, "
                  "light in this part comes from the other images (default: 15 with several images)")
      .check(check::range(0.0, 90.0));
  // Declare the map.
  command.add_option("--rows", options->unwrapping.rows, "Rows of the map, which has twice as many columns")
      .check(check::range(1, 8192))
      .capture_default_str();
  command.add_option("--reflectance", options->unwrapping.reflectance, "Reflectance of the mirror")
      .capture_default_str();
  command.add_input("--truth", options->truth, "True environment, to print the error (" + radiance_formats() + ")");
  command.add_output("--image", options->image, {".png"}, "Image to write: the photographs beside the map (.png)");
  add_threads_option(command, options->threads);
  command
      .add_output("-o,--output", options->output, {".hdr", ".npy", ".exr"},
                  "Map to write, latitude-longitude (" + radiance_formats() + ")")
      .required();
  command.callback([options] { unwrap(*options); });
}

}  // namespace cli
