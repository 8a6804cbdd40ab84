/// gonio near-field: converts images of a flat sample, taken from a short distance, to measurements of one material, or
/// of several materials that are separated by clustering colours.

#include "commands.hpp"
#include "tool/files/photograph_files.hpp"
#include "tool/files/radiance_image.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/capture/colour_clusters.hpp>
#include <gonio/estimate/pose_refinement.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/setups/near_field_setup.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace cli {

namespace {

struct near_field_command {
  photograph_files files;
  std::string clusters;  ///< a number, auto, or empty for one material
  std::filesystem::path labels, prior, output;
  double angular_error = 0.0;  ///< degrees; 0: light and cameras are exactly placed
  bool reference_in_place = false;
  std::uint64_t seed = 0;
  gonio::thread_count threads;
};

using taken_image = taken_photograph<gonio::capture::near_field_setup>;

std::vector<taken_image> read_images(const near_field_command& options) {
  return read_photographs(options.files, [](const std::string& file, const auto& calibration) {
    return gonio::io::read_near_field_setup(file, calibration);
  });
}

gonio::sample_set samples_of(const taken_image& image) {
  return image.naming_files([&] { return gonio::capture::near_field_samples(image.pixels, image.setup, image.white); });
}

/// Returns whether the white reference was in the sample's place: it then received the same light as the sample,
/// wherever the light was.
bool has_reference_in_place(const std::vector<taken_image>& images, const near_field_command& options) {
  return options.reference_in_place ||
         std::ranges::all_of(images, [](const taken_image& each) { return each.white && !each.white->surface; });
}

std::string angle_of(const Eigen::Vector3d& turn) { return fixed(gonio::degrees(turn.norm()), 2); }

/// For each material, the samples of each image.
using samples_of_materials = std::vector<std::vector<gonio::sample_set>>;

/// Refines the poses of light and cameras, which all materials share, and prints the corrections. Returns each
/// material's samples.
std::vector<gonio::sample_set> refined(const std::vector<taken_image>& images, samples_of_materials samples,
                                       const near_field_command& options) {
  gonio::pose_refinement refinement(
      read_prior(options.prior), std::move(samples),
      {.deviation = gonio::radians(options.angular_error),
       .calibrated_by = has_reference_in_place(images, options) ? gonio::light_calibration::reference_in_place
                                                                : gonio::light_calibration::irradiance,
       .threads = options.threads});
  refinement.solve();
  for (Eigen::Index i = 0; i < std::ssize(images); ++i)
    std::cout << images[i].file << ": light corrected by " << angle_of(refinement.turns()[i].light)
              << " degrees, camera by " << angle_of(refinement.turns()[i].camera) << '\n';
  std::vector<gonio::sample_set> all;
  for (Eigen::Index m = 0; m < refinement.materials(); ++m) all.push_back(refinement.samples(m));
  return all;
}

/// Returns each material's samples from all images.
std::vector<gonio::sample_set> joined(const std::vector<taken_image>& images, samples_of_materials samples,
                                      const near_field_command& options) {
  if (options.angular_error != 0.0) return refined(images, std::move(samples), options);
  std::vector<gonio::sample_set> all(samples.size());
  for (std::size_t m = 0; m < samples.size(); ++m)
    for (const gonio::sample_set& own : samples[m]) all[m].insert(all[m].end(), own.begin(), own.end());
  return all;
}

/// Returns the number of samples of each image, one line per image.
std::string counts_of(const std::vector<taken_image>& images, const std::vector<gonio::sample_set>& samples) {
  std::string lines;
  for (Eigen::Index i = 0; i < std::ssize(images); ++i)
    lines += images[i].file + ": " + counted(std::ssize(samples[i]), "sample") + '\n';
  return lines;
}

/// Writes the samples of all images to one file; prints their number for each image.
void write_samples_of_one(const std::vector<taken_image>& images, const near_field_command& options) {
  std::vector<gonio::sample_set> samples;
  for (const taken_image& image : images) samples.push_back(samples_of(image));
  const std::string counts = counts_of(images, samples);
  gonio::io::write_samples(options.output, joined(images, {std::move(samples)}, options).front());
  std::cout << counts;
}

// ---- several materials -------------------------------------------------------------------------

/// Refuses a moving camera: a pixel must show the same point of the sample in all images.
void require_fixed_camera(const std::vector<taken_image>& images) {
  const gonio::pinhole_camera& first = images.front().setup.camera.pinhole();
  for (const taken_image& image : images) {
    const gonio::pinhole_camera& camera = image.setup.camera.pinhole();
    if (camera.intrinsics().rows != first.intrinsics().rows ||
        camera.intrinsics().columns != first.intrinsics().columns || camera.position() != first.position() ||
        camera.rotation() != first.rotation())
      gonio::refuse(image.setup_file + ": --clusters needs a fixed camera, but it differs from " +
                    images.front().setup_file);
  }
}

/// Clusters the pixels of an image's region by their reflectance.
gonio::capture::colour_clusters clusters_of(const taken_image& image, const near_field_command& options) {
  static_cast<void>(samples_of(image));  // refuses an unusable image
  const std::vector<gonio::rgb> values = gonio::capture::region_reflectance(image.pixels, image.setup, image.white);
  gonio::capture::point_matrix colours(std::ssize(values), 3);
  for (Eigen::Index i = 0; i < colours.rows(); ++i) colours.row(i) = values[i].matrix().transpose();
  if (options.clusters == "auto")
    return gonio::capture::cluster_colours(colours, gonio::capture::cluster_count_choice{}, options.seed,
                                           options.threads);
  Eigen::Index count = 0;
  const std::string& text = options.clusters;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (failed != std::errc() || end != text.data() + text.size() || count < 1)
    gonio::refuse("--clusters needs a positive number or auto, not '" + text + "'");
  return gonio::capture::cluster_colours(colours, count, options.seed, options.threads);
}

/// Returns FILE-2.csv for FILE.csv and material 2.
std::filesystem::path path_of_material(const std::filesystem::path& output, Eigen::Index material) {
  std::filesystem::path path = output;
  path.replace_filename(output.stem().string() + '-' + std::to_string(material + 1) + output.extension().string());
  return path;
}

/// Returns an image with each material's pixels in its mean colour, scaled so that the brightest colour is 1; black
/// outside the region.
gonio::image label_map(const gonio::capture::colour_clusters& clusters, const std::vector<Eigen::Index>& region,
                       const gonio::camera_intrinsics& size) {
  gonio::image map = gonio::uniform_image(size.rows, size.columns);
  const double brightest = std::max(clusters.centres.maxCoeff(), 1e-30);
  for (std::size_t i = 0; i < region.size(); ++i)
    gonio::set_pixel(map, region[i] / size.columns, region[i] % size.columns,
                     gonio::rgb(clusters.centres.row(clusters.labels[i]).transpose().array() / brightest));
  return map;
}

/// Writes a file of samples for each material, whose pixels are a cluster of the last image.
void write_samples_of_each(std::vector<taken_image> images, const command& given, const near_field_command& options) {
  require_fixed_camera(images);
  const taken_image& diffuse = images.back();
  const gonio::camera_intrinsics size = diffuse.setup.camera.intrinsics();
  const std::vector<Eigen::Index> region = gonio::capture::pixels_of_region(diffuse.setup);
  const gonio::capture::colour_clusters clusters = clusters_of(diffuse, options);
  for (Eigen::Index material = 0; material < clusters.count(); ++material)
    given.require_writable(path_of_material(options.output, material));
  if (!options.labels.empty()) gonio::io::write_png(options.labels, label_map(clusters, region, size));
  samples_of_materials samples;
  std::vector<std::string> counts;
  for (Eigen::Index material = 0; material < clusters.count(); ++material) {
    std::vector<bool> mask(size.rows * size.columns, false);
    for (const Eigen::Index pixel : clusters.pixels(material)) mask[region[pixel]] = true;
    auto& own = samples.emplace_back();
    for (taken_image& image : images) {
      image.setup.mask = mask;
      own.push_back(samples_of(image));
    }
    counts.push_back(counts_of(images, own));
  }
  const std::vector<gonio::sample_set> all = joined(images, std::move(samples), options);
  for (Eigen::Index material = 0; material < clusters.count(); ++material) {
    const std::filesystem::path path = path_of_material(options.output, material);
    gonio::io::write_samples(path, all[material]);
    std::cout << path.string() << ", " << clusters.sizes[material] << " pixels\n" << counts[material];
  }
}

void run(const command& given, const near_field_command& options) {
  if (options.reference_in_place && options.angular_error == 0.0)
    gonio::refuse("--reference-in-place needs --misplaced");
  if (options.clusters.empty() && !options.labels.empty()) gonio::refuse("--labels needs --clusters");
  std::vector<taken_image> images = read_images(options);
  if (options.clusters.empty())
    write_samples_of_one(images, options);
  else
    write_samples_of_each(std::move(images), given, options);
}

}  // namespace

void add_near_field(command& app) {
  auto command = app.add_subcommand("near-field", "Convert images of a flat sample to samples for gonio reconstruct");
  const auto options = std::make_shared<near_field_command>();
  add_photograph_options(command, options->files, "images",
                         "Images of linear radiance (" + radiance_formats() +
                             "), each followed by its set-up "
                             "(docs/reference/formats.md): camera, light and region of interest");
  command.add_option(
      "--clusters", options->clusters,
      "Number of materials, or auto. They are separated by colour in the last image, which should show no highlight. "
      "Each material gets a file: OUTPUT-1.csv for the one with the most pixels, and so on");
  command.add_output("--labels", options->labels, {".png"}, "Image to write of the material of each pixel (.png)");
  command
      .add_option("--misplaced", options->angular_error,
                  "Standard deviation of the directions of lights and cameras in the set-ups, in degrees. If positive, "
                  "corrects these directions with --prior")
      .capture_default_str();
  command.add_flag("--reference-in-place", options->reference_in_place,
                   "With --misplaced: the irradiance comes from a white reference at the sample's position, so a "
                   "misplaced light does not scale the values. Implied by --white without 'white_plane'");
  add_prior_option(command, options->prior);
  command.add_option("--seed", options->seed, "Seed of the clusters").capture_default_str();
  add_threads_option(command, options->threads);
  command.add_output("-o,--output", options->output, {".csv"}, "Samples to write (.csv)").required();
  command.callback([command, options] { run(command, *options); });
}

}  // namespace cli
