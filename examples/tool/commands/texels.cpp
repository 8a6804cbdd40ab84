/// gonio texels: writes the texels of a map of gonio svbrdf as images, arrays and materials.

#include "commands.hpp"
#include "texel_clusters.hpp"
#include "tool/files/file_start.hpp"
#include "tool/files/texel_arrays.hpp"
#include "tool/options/lights.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/colour_scale.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/flat_sample.hpp"
#include <gonio/core/half.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/render/exposure.hpp>
#include <gonio/render/false_colour.hpp>

#include <array>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cli {

namespace {

struct texels_options {
  std::filesystem::path map, prior, uncertainty, disagreement, labels, materials, tables, other, delta_e;
  Eigen::Index clusters = 0;
  std::uint64_t seed = 1;
  std::vector<std::string> lights;
  std::optional<double> exposure;
  gonio::thread_count threads;
};

using band = gonio::io::svbrdf_band;

bool is_png(const std::filesystem::path& path) { return lower_extension(path) == ".png"; }

/// Writes an image of the map; texels outside the sample are black.
void write_texel_image(const std::filesystem::path& path, const gonio::io::svbrdf_map& map,
                       const std::function<std::vector<gonio::rgb>(const band&, Eigen::Index)>& colours_of,
                       const colour_scale* scale) {
  const gonio::io::svbrdf_header& header = map.header();
  const auto rows = static_cast<std::size_t>(header.rows), columns = static_cast<std::size_t>(header.columns);
  gonio::image picture = gonio::uniform_image(scale == nullptr ? rows : rows_with_scale(rows, columns), columns);
  float* next = picture.data();
  for (Eigen::Index number = 0; number < header.bands(); ++number) {
    const band read = map.read_band(number);
    const std::vector<gonio::rgb> colours = colours_of(read, number);
    for (Eigen::Index texel = 0; texel < header.texels_of_band(number); ++texel, next += 3)
      if (read.has_material(texel)) std::ranges::copy(colours[static_cast<std::size_t>(texel)].cast<float>(), next);
  }
  if (picture.shape(0) > rows) draw_scale(picture, *scale);
  gonio::io::write_png(path, picture);
}

/// Writes one member of all bands as an array or as an image. In an image, a number has the colour at the position
/// `share_of(number)` of the scale.
void write_part(const std::filesystem::path& path, const gonio::io::svbrdf_map& map,
                std::vector<std::uint16_t> band::*part, const colour_scale& scale,
                const std::function<double(double)>& share_of) {
  if (path.empty()) return;
  if (!is_png(path)) return write_texel_array(path, map, part, {});
  const auto colours_of = [&](const band& read, Eigen::Index) {
    std::vector<gonio::rgb> colours;
    for (const std::uint16_t half : read.*part) colours.push_back(scale.colour(share_of(gonio::from_half(half))));
    return colours;
  };
  write_texel_image(path, map, colours_of, &scale);
}

/// Returns the position of an uncertainty on a scale from 0.1 to 5. A texel's uncertainty is the root mean square over
/// all directions, which is larger than the uncertainty of most directions: with 20 images, about 1.
double position_of_uncertainty(double uncertainty) {
  return gonio::render::logarithmic_position(uncertainty, 0.1, 5.0);
}

colour_scale scale_of_uncertainty() {
  const auto at = position_of_uncertainty;
  return {gonio::render::sequential_colour,
          {{0.0, "0.1"}, {at(0.2), "0.2"}, {at(0.5), "0.5"}, {at(1.0), "1"}, {at(2.0), "2"}, {1.0, "5"}}};
}

// ---- clusters ----------------------------------------------------------------------------------

/// Writes the mean weights of the prior's components: clusters x 3 x components.
void write_materials(const std::filesystem::path& path, const texel_clusters& clusters, Eigen::Index components) {
  xt::xtensor<float, 3> means(
      std::array<std::size_t, 3>{static_cast<std::size_t>(clusters.count()), 3, static_cast<std::size_t>(components)});
  for (Eigen::Index k = 0; k < clusters.count(); ++k) {
    const Eigen::MatrixXd weights = clusters.mean_weights(k);
    for (Eigen::Index c = 0; c < 3; ++c)
      for (Eigen::Index i = 0; i < components; ++i) means(k, c, i) = static_cast<float>(weights(i, c));
  }
  gonio::io::write_npy(path, means);
}

void write_tables(const std::filesystem::path& folder, const texel_clusters& clusters,
                  const gonio::log_relative_pca& prior, gonio::thread_count threads) {
  std::filesystem::create_directories(folder);
  for (Eigen::Index k = 0; k < clusters.count(); ++k)
    gonio::io::write_merl(folder / ("material-" + std::to_string(k + 1) + ".binary"),
                          gonio::fitted_brdf(prior, clusters.mean_weights(k)).tabulate(gonio::valid_cells(), threads));
}

/// Assigns all bands, and writes the labels if requested.
void write_labels(const std::filesystem::path& path, const gonio::io::svbrdf_map& map, texel_clusters& clusters) {
  if (path.empty()) {
    for (Eigen::Index number = 0; number < map.header().bands(); ++number)
      static_cast<void>(clusters.assign(map.read_band(number)));
  } else if (is_png(path)) {
    const auto colours_of = [&](const band& read, Eigen::Index) {
      std::vector<gonio::rgb> colours;
      for (const std::uint8_t label : clusters.assign(read))
        colours.push_back(label == 0 ? gonio::rgb(gonio::rgb::Zero()) : gonio::render::category_colour(label - 1));
      return colours;
    };
    write_texel_image(path, map, colours_of, nullptr);
  } else {
    write_texel_array(path, map.header(), "|u1", {}, [&](gonio::io::file_writer& file, Eigen::Index number) {
      const std::vector<std::uint8_t> labels = clusters.assign(map.read_band(number));
      file.write(std::as_bytes(std::span(labels)));
    });
  }
}

void print_clusters(const texel_clusters& clusters) {
  double texels = 0.0;
  for (const auto& each : clusters.summary()) texels += each.texels;
  for (std::size_t k = 0; k < clusters.summary().size(); ++k) {
    const auto& own = clusters.summary()[k];
    std::cout << "cluster " << k + 1 << ": " << fixed(100.0 * own.texels / std::max(texels, 1.0), 1)
              << " % of the texels; distance from the centre in logarithms of reflectance: " << fixed(own.distance(), 2)
              << " (root mean square)\n";
  }
}

void cluster(const texels_options& options, const gonio::io::svbrdf_map& map, const gonio::log_relative_pca& prior) {
  if (options.clusters > gonio::render::categories && is_png(options.labels))
    gonio::refuse({"--labels: ", gonio::render::categories, " clusters have distinct colours in a .png, not ",
                   options.clusters, ": give a .npy file"});
  texel_clusters clusters(map, prior, options.clusters, options.seed, options.threads);
  write_labels(options.labels, map, clusters);
  if (!options.materials.empty()) write_materials(options.materials, clusters, prior.size());
  if (!options.tables.empty()) write_tables(options.tables, clusters, prior, options.threads);
  print_clusters(clusters);
}

// ---- two maps ----------------------------------------------------------------------------------

/// Returns Delta E of each texel of two maps under some lights, with the first map's exposure unless one is given.
std::vector<float> differences_of(const flat_sample& one, const flat_sample& other,
                                  const std::optional<double>& given_exposure, gonio::thread_count threads) {
  const gonio::image radiance = one.radiance(threads);
  const double exposure = given_exposure ? *given_exposure : gonio::render::exposure_of(radiance);
  const auto shown = [&](const float* pixel) {
    return gonio::rgb((exposure * Eigen::Map<const Eigen::Array3f>(pixel).cast<double>()).cast<float>().cast<double>());
  };
  std::vector<float> found(radiance.size() / 3);
  const gonio::io::svbrdf_header& header = one.header();
  for (Eigen::Index first = 0; first < header.rows; first += header.band_rows) {
    // The rows of this band, which may lie in several bands of the other map.
    const gonio::block rows{first, std::min(first + header.band_rows, header.rows)};
    const std::vector<float> others = other.radiance(rows, threads);
    gonio::for_each_index(
        rows.size() * header.columns, 4096,
        [&](Eigen::Index i) {
          const Eigen::Index texel = first * header.columns + i;
          found[static_cast<std::size_t>(texel)] =
              static_cast<float>(gonio::delta_e(shown(radiance.data() + 3 * texel), shown(others.data() + 3 * i)));
        },
        threads);
  }
  return found;
}

void compare(const texels_options& options, const gonio::io::svbrdf_map& map, const gonio::log_relative_pca& prior) {
  const gonio::io::svbrdf_map other(options.other);
  const gonio::io::svbrdf_header& header = map.header();
  if (other.header().rows != header.rows || other.header().columns != header.columns)
    gonio::refuse({options.other.native(), ": has ", other.header().columns, " x ", other.header().rows,
                   " texels, but ", options.map.native(), " has ", header.columns, " x ", header.rows});
  const auto lighting = lighting_of(options.lights);
  const std::vector<float> differences = differences_of(
      {map, prior, lighting.lights()}, {other, prior, lighting.lights()}, options.exposure, options.threads);
  const auto of_band = [&](Eigen::Index number) {
    return std::span(differences)
        .subspan(static_cast<std::size_t>(number * header.band_rows * header.columns),
                 static_cast<std::size_t>(header.texels_of_band(number)));
  };
  double sum = 0.0;
  for (const float each : differences) sum += double{each};
  std::cout << "Delta E of the maps: " << fixed(sum / static_cast<double>(differences.size()), 2) << " on average\n";
  if (!is_png(options.delta_e))
    return write_texel_array(
        options.delta_e, header, "<f4", {},
        [&](gonio::io::file_writer& file, Eigen::Index number) { file.write(std::as_bytes(of_band(number))); });
  const colour_scale scale{gonio::render::sequential_colour,
                           {{0.0, "0"}, {0.2, "2"}, {0.4, "4"}, {0.6, "6"}, {0.8, "8"}, {1.0, "10+"}}};
  const auto colours_of = [&](const band&, Eigen::Index number) {
    std::vector<gonio::rgb> colours;
    for (const float each : of_band(number)) colours.push_back(scale.colour(0.1 * double{each}));
    return colours;
  };
  write_texel_image(options.delta_e, map, colours_of, &scale);
}

void run(const texels_options& options) {
  const gonio::io::svbrdf_map map(options.map);
  if (options.uncertainty.empty() && options.disagreement.empty() && options.clusters == 0 && options.other.empty())
    gonio::refuse("texels needs one of --uncertainty, --disagreement, --clusters and --compare");
  const colour_scale of_uncertainty = scale_of_uncertainty();
  write_part(options.uncertainty, map, &band::uncertainty, of_uncertainty, position_of_uncertainty);
  const colour_scale of_disagreement{gonio::render::sequential_colour,
                                     {{0.0, "0"}, {0.25, "1"}, {0.5, "2"}, {0.75, "3"}, {1.0, "4+"}}};
  write_part(options.disagreement, map, &band::disagreement, of_disagreement,
             [](double value) { return 0.25 * value; });
  if (options.clusters == 0 && options.other.empty()) return;
  const gonio::log_relative_pca prior = read_prior(options.prior);
  if (options.clusters > 0) cluster(options, map, prior);
  if (!options.other.empty()) compare(options, map, prior);
}

}  // namespace

void add_texels(command& app) {
  auto command = app.add_subcommand(
      "texels", "Draw the uncertainty of a map's texels, their materials, or the difference of two maps");
  const auto options = std::make_shared<texels_options>();
  command.add_input("map", options->map, "Map of gonio svbrdf (.gsv)").required();
  add_prior_option(command, options->prior);
  command.add_output("--uncertainty", options->uncertainty, {".png", ".npy"},
                     "Image or array to write of each texel's uncertainty over all directions (68 of 100 cases): 0.1 "
                     "is 10 %, 1 is a factor of 2.7; light up to 0.1, dark from 5");
  command.add_output(
      "--disagreement", options->disagreement, {".png", ".npy"},
      "Image or array to write of the disagreement of each texel's images: light at 0, dark from 4; 1 is as expected");
  auto clusters = command
                      .add_option("--clusters", options->clusters,
                                  "Number of materials to divide the texels into, by k-means of logarithms of "
                                  "reflectance over all directions")
                      .check(check::range(1, 255));
  command
      .add_output("--labels", options->labels, {".png", ".npy"},
                  "Image (up to 8 clusters) or array of bytes to write: cluster of each texel from 1, the largest; 0 "
                  "(black) outside the sample")
      .needs(clusters);
  command
      .add_output(
          "--materials", options->materials, {".npy"},
          "Array to write of the weights of the clusters' mean materials: clusters x 3 x components of the prior")
      .needs(clusters);
  command
      .add_output_folder("--tables", options->tables, {"material-1.binary"},
                         "Folder to write with the mean materials, as MERL tables material-1.binary and so on")
      .needs(clusters);
  command.add_option("--seed", options->seed, "Seed of the clusters").needs(clusters).capture_default_str();
  auto other =
      command.add_input("--compare", options->other,
                        "Another map of the same texels and prior. Both maps are compared as seen along the normal");
  auto delta_e = command
                     .add_output("--delta-e", options->delta_e, {".png", ".npy"},
                                 "Image or array to write of CIELAB's Delta E of each texel: light at 0, dark from 10")
                     .needs(other);
  other.needs(delta_e);
  add_light_option(command, options->lights).needs(other);
  command
      .add_option("--exposure", options->exposure, "Value of a white Lambertian surface that faces a light; 1 is white")
      .check(check::positive_number())
      .default_str("white at the 99th percentile of the first map")
      .needs(other);
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace cli
