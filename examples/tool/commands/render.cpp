/// gonio render: draws tables side by side.

#include "commands.hpp"
#include "tool/files/exr_files.hpp"
#include "tool/files/file_kinds.hpp"
#include "tool/files/file_start.hpp"
#include "tool/files/radiance_image.hpp"
#include "tool/options/lights.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/colour_scale.hpp"
#include "tool/pages/contact_sheet.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/flat_sample.hpp"
#include "tool/pages/images.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/render/anisotropic_sampler.hpp>
#include <gonio/render/false_colour.hpp>
#include <gonio/render/half_vector_sampler.hpp>
#include <gonio/render/lookup_table.hpp>
#include <gonio/render/sampled_sphere.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace cli {

namespace {

/// The default exposure in an environment, where no highlight is much brighter than its surroundings.
constexpr double exposure_in_environment = 0.4;

struct render_options {
  std::vector<std::filesystem::path> tables;
  std::vector<std::string> lights;
  std::filesystem::path output, environment, prior;
  bool slices = false, compares = false, labels = false;
  std::string caption;
  int quality = 64, columns = 0;  ///< columns of a contact sheet; 0: one row
  image_options image{.size = 512, .exposure = {}};
  std::uint64_t seed = 1;
  gonio::thread_count threads;
};

bool is_exr(const std::filesystem::path& path) { return lower_extension(path) == ".exr"; }

/// CIELAB's Delta E of each pixel of two images as a colour, as in Noell et al. 2014, Fig. 3, and its mean. Pixels that
/// are black in both images, beside the sphere or unlit, do not count.
struct image_difference {
  gonio::image image;
  double mean = 0.0;
};

image_difference difference_of(const gonio::image& one, const gonio::image& other) {
  image_difference found{gonio::uniform_image(one.shape(0), one.shape(1), gonio::rgb::Zero())};
  double sum = 0.0, count = 0.0;
  for (std::size_t row = 0; row < one.shape(0); ++row)
    for (std::size_t column = 0; column < one.shape(1); ++column) {
      const gonio::rgb a = gonio::pixel(one, row, column), b = gonio::pixel(other, row, column);
      if ((a == 0.0).all() && (b == 0.0).all()) continue;
      const double delta_e = (gonio::to_lab(a) - gonio::to_lab(b)).matrix().norm();
      sum += delta_e;
      count += 1.0;
      gonio::set_pixel(found.image, row, column, gonio::render::difference_colour(delta_e));
    }
  found.mean = count > 0.0 ? sum / count : 0.0;
  draw_scale(found.image, delta_e_scale());  // at the bottom, where a sphere is narrow
  return found;
}

/// Refuses inputs that --compare cannot draw, before drawing.
void require_comparable(const render_options& options) {
  if (options.tables.size() != 2)
    gonio::refuse("--compare needs two tables, not " + std::to_string(options.tables.size()));
  if (is_exr(options.output)) gonio::refuse("--compare needs an output (-o) that ends in .png");
  if (options.image.size < static_cast<int>(smallest_with_scale))
    gonio::refuse("--compare needs a --size of at least " + std::to_string(smallest_with_scale) +
                  ", for the numbers of its scale");
}

/// Returns the caption and, with --labels, the tables' names without folders and extensions.
sheet_text text_of(const render_options& options) {
  sheet_text text{{}, options.caption};
  if (!options.labels) return text;
  for (std::filesystem::path name : options.tables) {
    name = name.filename();
    if (lower_extension(name) == ".gz") name.replace_extension();
    text.labels.push_back(name.stem().string());
  }
  if (options.compares) text.labels.emplace_back("Delta E");
  return text;
}

/// Refuses text in an image of radiance.
void require_no_text(const render_options& options) {
  if (is_exr(options.output) && (options.labels || !options.caption.empty()))
    gonio::refuse("--labels and --caption need an output (-o) that ends in .png");
}

/// Draws the flat sample of a map, alone in its image.
void render_flat_sample(const render_options& options) {
  if (options.tables.size() != 1 || options.slices || options.compares || !options.environment.empty() ||
      options.labels || !options.caption.empty())
    gonio::refuse(
        {options.tables.front().native(),
         ": a map needs to be the only input; not available with it: --slices, --compare, --environment, --labels and ",
         "--caption"});
  const gonio::image sample =
      flat_sample_image(options.tables.front(), options.prior, lighting_of(options.lights).lights(),
                        options.image.exposure, options.threads);
  if (is_exr(options.output)) return write_exr(options.output, sample);
  gonio::io::write_png(options.output, sample);
}

/// Draws a material by itself.
class material_painter {
 public:
  material_painter(const render_options& options, const gonio::render::environment_sampler* light)
      : options_(options), light_(light), lamps_(lighting_of(options.lights)) {}

  [[nodiscard]] gonio::image operator()(const gonio::brdf_table& table) {
    if (options_.slices) return slice_image(table, options_.image, options_.threads);
    if (light_ == nullptr) return sphere_image(table, options_.image, options_.threads, lamps_);
    return in_environment(gonio::render::half_vector_sampler(gonio::render::lookup_table<>::of(table)), false);
  }

  /// An anisotropic material.
  template <gonio::brdf Brdf>
  [[nodiscard]] gonio::image operator()(const Brdf& f) {
    if (light_ == nullptr) return turned_sphere_image(f, options_.image, options_.threads, lamps_);
    return in_environment(gonio::render::anisotropic_sampler(f), true);
  }

 private:
  template <class Sampler>
  [[nodiscard]] gonio::image in_environment(const Sampler& material, bool is_turned) {
    const gonio::render::sampled_sphere_view view{.size = options_.image.size,
                                                  .samples = options_.quality,
                                                  .seed = options_.seed,
                                                  .white = options_.image.exposure.value_or(exposure_in_environment),
                                                  .is_turned = is_turned};
    return gonio::render::render_sphere(material, *light_, view, options_.threads, bar_.listener());
  }

  const render_options& options_;
  const gonio::render::environment_sampler* light_;
  gonio::render::directional_lighting lamps_;
  progress_bar bar_;
};

void render(const render_options& options) {
  require_no_text(options);
  if (gonio::io::is_svbrdf_map(options.tables.front())) return render_flat_sample(options);
  if (options.compares) require_comparable(options);
  std::optional<gonio::render::environment_sampler> light;
  if (!options.environment.empty()) light.emplace(gonio::render::environment_map(read_radiance(options.environment)));
  material_painter image_of(options, light ? &*light : nullptr);
  std::vector<gonio::image> images;
  for (const auto& path : options.tables) {
    const any_material material =
        options.slices ? any_material(read_table(path, options.threads)) : read_material(path, options.threads);
    images.push_back(std::visit(image_of, material));
  }
  if (!options.slices && !light) expose_spheres(images, options.image);
  if (options.compares) {
    auto [image, mean] = difference_of(images[0], images[1]);
    images.push_back(std::move(image));
    std::cout << "Delta E of the images: " << fixed(mean, 2) << " on average; 0 is light, 20 and more dark\n";
  }
  const gonio::image beside = contact_sheet(
      images, options.columns == 0 ? images.size() : std::min<std::size_t>(options.columns, images.size()),
      text_of(options));
  if (is_exr(options.output))
    write_exr(options.output, beside);
  else
    gonio::io::write_png(options.output, beside);
}

}  // namespace

void add_render(command& app) {
  auto command = app.add_subcommand(
      "render", "Draw tables as spheres under two lights or in an environment, or as slices, side by side");
  const auto options = std::make_shared<render_options>();
  command
      .add_input(
          "tables", options->tables,
          "Tables (.binary, .binary.gz, .npy, .bsdf, .mbsdf or .bin), left to right, the grooves of anisotropic ones "
          "about the vertical axis; or a map of gonio svbrdf (.gsv), a pixel for each texel")
      .required();
  add_prior_option(command, options->prior);
  command
      .add_output("-o,--output", options->output, {".png", ".exr"},
                  std::string("Image to write: .png") +
                      (has_exr ? ", or .exr for the values themselves (slices: pi times the BRDF)" : ""))
      .required();
  auto slices = command.add_flag("--slices", options->slices,
                                 "Draw slices at phi_d = 90 degrees: theta_h to the right, theta_d upwards");
  auto environment =
      command.add_input("--environment", options->environment,
                        "Environment that lights the spheres: a latitude-longitude image (" + radiance_formats() + ")");
  environment.excludes(slices);
  add_light_option(command, options->lights).excludes(environment).excludes(slices);
  command
      .add_option("--quality", options->quality,
                  "Number of direction pairs per pixel, sampled from the BRDF and from the environment")
      .check(check::range(1, 1'000'000))
      .needs(environment)
      .capture_default_str();
  command.add_flag("--compare", options->compares,
                   "Draw a third image of the colour difference of two tables, CIELAB's Delta E of each pixel");
  command.add_option("--columns", options->columns, "Number of images in a row, for a contact sheet of many tables")
      .check(check::range(1, 1000))
      .default_str("all in one row");
  command.add_flag("--labels", options->labels, "Write the name of its table under each image");
  command.add_option("--caption", options->caption, "Line of text under all images");
  add_image_options_to(command, options->image,
                       "0.4 in an environment; under lights, white at the 99th percentile of the brightest sphere")
      .second.excludes(slices);
  command.add_option("--seed", options->seed, "Seed of the samples").needs(environment).capture_default_str();
  add_threads_option(command, options->threads);
  command.callback([options] { render(*options); });
}

}  // namespace cli
