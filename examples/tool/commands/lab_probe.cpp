/// gonio lab probe, gonio lab unwrap: images an environment in a mirror sphere, and unwraps such an image.

#include "lab.hpp"
#include "lab/mirror_sphere_lab.hpp"
#include "tool/files/radiance_image.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/capture/mirror_sphere.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/render/image.hpp>

#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <numeric>

namespace cli {

namespace {

struct probe_command {
  std::filesystem::path input, output, truth, image;
  double distance = 0.0;  ///< in radii of the sphere; 0: infinite
  std::size_t pixels = 1024;
  gonio::capture::unwrap_options unwrapping;
  gonio::thread_count threads;
};

gonio::capture::mirror_sphere sphere_of(const probe_command& options) {
  return options.distance > 0.0 ? gonio::capture::mirror_sphere(options.distance) : gonio::capture::mirror_sphere();
}

void photograph(const probe_command& options) {
  const gonio::render::environment_map around(read_radiance(options.input));
  const auto radiance = [&](const gonio::direction& towards) { return around(towards); };
  write_radiance(options.output, lab::photograph(sphere_of(options), radiance, options.pixels));
}

/// Returns an image with fewer rows, each pixel the mean of those it replaces.
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

/// Returns the probe beside the map, exposed so that the map's mean is middle grey; highlights are clipped.
gonio::image image_of(const gonio::image& probe, const gonio::image& map, const std::filesystem::path& file) {
  const std::array both{averaged(probe, map.shape(0), file), map};
  gonio::image image = gonio::render::side_by_side(both, 4);
  const double mean = std::accumulate(map.data(), map.data() + map.size(), 0.0) / static_cast<double>(map.size());
  const auto exposure = static_cast<float>(mean > 0.0 ? 0.18 / mean : 1.0);
  std::transform(image.data(), image.data() + image.size(), image.data(),
                 [=](float value) { return exposure * value; });
  return image;
}

/// Returns the mean relative error of a map, weighted by solid angle, except within 10 degrees of the part that the
/// sphere hides. Pixels whose truth is black are ignored.
double relative_error(const gonio::image& map, const gonio::render::environment_map& truth,
                      double largest_polar_angle) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t row = 0; row < truth.rows(); ++row)
    for (std::size_t column = 0; column < truth.columns(); ++column) {
      const gonio::rgb expected = gonio::pixel(truth.image(), row, column);
      if (std::acos(truth.towards(row, column).z()) > largest_polar_angle - gonio::radians(10.0)) continue;
      if (!(expected > 0.0).all()) continue;
      const gonio::rgb off = (gonio::pixel(map, row, column) - expected).abs() / expected;
      sum += truth.solid_angle(row) * off.mean();
      weights += truth.solid_angle(row);
    }
  return sum / weights;
}

void unwrap(const probe_command& options) {
  const gonio::capture::mirror_sphere sphere = sphere_of(options);
  const gonio::image probe = read_radiance(options.input);
  const auto map = [&] {
    try {
      return gonio::capture::unwrap(probe, sphere, options.unwrapping, options.threads);
    } catch (const gonio::error& refusal) {
      gonio::refuse(options.input.string() + ": " + refusal.what());
    }
  }();
  write_radiance(options.output, map);
  if (!options.image.empty()) gonio::io::write_png(options.image, image_of(probe, map, options.input));
  if (options.truth.empty()) return;
  const gonio::render::environment_map truth(
      averaged(read_radiance(options.truth), options.unwrapping.rows, options.truth));
  std::cout << "mean relative error " << fixed(100.0 * relative_error(map, truth, sphere.largest_polar_angle()), 2)
            << " %, except within 10 degrees of the part that the sphere hides\n";
}

void add_distance_option(command& to, double& distance) {
  to.add_option("--distance", distance,
                "Distance from the sphere's centre to the camera, in radii of the sphere (default: infinite)")
      .check(check::range(1.001, 1e6));
}

}  // namespace

void add_lab_probe(command& lab) {
  auto command = lab.add_subcommand("probe", "Photograph a mirror sphere in an environment");
  const auto options = std::make_shared<probe_command>();
  command
      .add_input("environment", options->input,
                 "Environment to photograph, latitude-longitude (" + radiance_formats() + ")")
      .required();
  add_distance_option(command, options->distance);
  command.add_option("--size", options->pixels, "Rows and columns of the image")
      .check(check::range(8, 8192))
      .capture_default_str();
  command
      .add_output("-o,--output", options->output, {".hdr", ".npy", ".exr"},
                  "Image of the sphere to write, square and without a margin (" + radiance_formats() + ")")
      .required();
  command.callback([options] { photograph(*options); });
}

void add_lab_unwrap(command& lab) {
  auto command = lab.add_subcommand("unwrap", "Convert an image of a mirror sphere to an environment map");
  const auto options = std::make_shared<probe_command>();
  command
      .add_input("image", options->input,
                 "Square image of the sphere without a margin, linear radiance (" + radiance_formats() + ")")
      .required();
  add_distance_option(command, options->distance);
  command.add_option("--rows", options->unwrapping.rows, "Rows of the map, which has twice as many columns")
      .check(check::range(1, 8192))
      .capture_default_str();
  command.add_option("--reflectance", options->unwrapping.reflectance, "Reflectance of the mirror")
      .capture_default_str();
  command.add_input("--truth", options->truth, "True environment, to print the error (" + radiance_formats() + ")");
  command.add_output("--image", options->image, {".png"}, "Image to write: the photograph beside the map (.png)");
  add_threads_option(command, options->threads);
  command
      .add_output("-o,--output", options->output, {".hdr", ".npy", ".exr"},
                  "Map to write, latitude-longitude (" + radiance_formats() + ")")
      .required();
  command.callback([options] { unwrap(*options); });
}

}  // namespace cli
