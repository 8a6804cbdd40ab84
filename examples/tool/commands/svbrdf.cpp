/// gonio svbrdf: completes registered images of a flat sample to a BRDF for each texel.

#include "commands.hpp"
#include "tool/files/image_stack.hpp"
#include "tool/files/radiance_image.hpp"
#include "tool/files/texel_arrays.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/team.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/estimate/eta_of_noise.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/texels/texel_decomposition.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cli {

namespace {

struct svbrdf_command {
  std::filesystem::path images, prior, output, weights, functions, uncertainty, disagreement;
  double noise = 0.02;
  std::optional<double> eta;
  gonio::thread_count threads;
};

/// Returns the directions of the images as samples with dummy values.
gonio::sample_set samples_of(const image_list& list) {
  gonio::sample_set samples;
  for (const listed_image& image : list.images) samples.push_back({image.at, gonio::rgb::Zero(), 1.0});
  return samples;
}

/// Computes the bands of a map from the images.
class svbrdf_job {
 public:
  explicit svbrdf_job(const svbrdf_command& options)
      : options_(options),
        list_(read_image_list(options.images)),
        prior_(read_prior(options.prior)),
        eta_(options.eta ? *options.eta
                         : gonio::eta_of_noise(prior_, samples_of(list_), options.noise, options.threads)),
        estimator_(prior_, gonio::locate_samples(prior_.cells(), samples_of(list_)).locations, gonio::tikhonov(eta_)),
        images_(list_, folder_of(options.output)) {}

  [[nodiscard]] gonio::io::svbrdf_header header() const {
    gonio::io::svbrdf_header header{.rows = images_.rows(),
                                    .columns = images_.columns(),
                                    .band_rows = std::min(images_.rows(), gonio::io::rows_of_band(images_.columns())),
                                    .eta = eta_,
                                    .prior_checksum = gonio::io::checksum_of(prior_),
                                    .prior_source = prior_.source(),
                                    .directions = {},
                                    .functions = estimator_.functions()};
    for (const listed_image& image : list_.images) header.directions.push_back(image.at);
    return header;
  }

  /// Returns a band's bytes in the map.
  [[nodiscard]] std::vector<std::byte> band(const gonio::io::svbrdf_header& header, Eigen::Index number) const {
    const texel_values values = images_.read(rows_of(header, number), options_.threads);
    images_.will_read(rows_of(header, number + 1));
    gonio::texel_estimates found = estimator_.solve(values.reflectance, options_.threads);
    for (const Eigen::Index texel : values.outside) found.clear(texel);
    return gonio::io::write_band(header, number, gonio::io::as_halves(found, options_.threads));
  }

  /// Returns a checksum of a few rows of all images.
  [[nodiscard]] std::uint32_t checksum_of_images() const {
    constexpr Eigen::Index most = 16;
    std::vector<std::uint32_t> each;
    for (Eigen::Index i = 0; i < std::min(most, images_.rows()); ++i) {
      const Eigen::Index row = i * images_.rows() / std::min(most, images_.rows());
      each.push_back(checksum_of_numbers(images_.read({row, row + 1}, options_.threads).reflectance));
    }
    return gonio::io::checksum(std::as_bytes(std::span(each)));
  }

 private:
  /// Returns the rows of a band; after the last band, an empty block.
  static gonio::block rows_of(const gonio::io::svbrdf_header& header, Eigen::Index band) {
    const Eigen::Index first = std::min(band * header.band_rows, header.rows);
    return {first, std::min(first + header.band_rows, header.rows)};
  }

  static std::uint32_t checksum_of_numbers(const Eigen::MatrixXf& numbers) {
    return gonio::io::checksum(std::as_bytes(std::span(numbers.data(), static_cast<std::size_t>(numbers.size()))));
  }

  static std::filesystem::path folder_of(const std::filesystem::path& file) {
    return file.has_parent_path() ? file.parent_path() : ".";
  }

  const svbrdf_command& options_;
  image_list list_;
  gonio::log_relative_pca prior_;
  double eta_;
  gonio::texel_decomposition estimator_;
  image_stack images_;
};

/// Writes the requested arrays of a complete map.
void write_arrays(const svbrdf_command& options) {
  const gonio::io::svbrdf_map map(options.output);
  const Eigen::MatrixXf& functions = map.header().functions;
  using band = gonio::io::svbrdf_band;
  if (!options.weights.empty())
    write_texel_array(options.weights, map, &band::weights, {3, static_cast<std::size_t>(functions.cols())});
  if (!options.uncertainty.empty()) write_texel_array(options.uncertainty, map, &band::uncertainty, {});
  if (!options.disagreement.empty()) write_texel_array(options.disagreement, map, &band::disagreement, {});
  if (options.functions.empty()) return;
  xt::xtensor<float, 2> columns(std::array<std::size_t, 2>{static_cast<std::size_t>(functions.rows()),
                                                           static_cast<std::size_t>(functions.cols())});
  for (Eigen::Index k = 0; k < functions.rows(); ++k)
    for (Eigen::Index r = 0; r < functions.cols(); ++r) columns(k, r) = functions(k, r);
  gonio::io::write_npy(options.functions, columns);
}

/// Begins or resumes the map of a job. Returns the number of bands it already has.
Eigen::Index open_map(std::optional<gonio::io::svbrdf_writer>& map, const svbrdf_job& job,
                      const std::filesystem::path& output) {
  const auto header = job.header();
  map.emplace(output, header);
  const Eigen::Index before = map->finished();
  if (before > 0 && !map->has_written(before - 1, job.band(header, before - 1)))
    gonio::refuse({output.string(), ".part: was begun with other images: remove it, or give another -o"});
  return before;
}

void print_done(const gonio::io::svbrdf_header& header, Eigen::Index before) {
  std::cout << header.columns << " x " << header.rows << " texels, " << header.directions.size() << " images, "
            << header.functions.rows() << " components, eta " << header.eta;
  if (before > 0) std::cout << ", resumed after band " << before << " of " << header.bands();
  std::cout << '\n';
}

void run(svbrdf_command options, const team& processes) {
  options.threads = processes.threads(options.threads);
  std::optional<svbrdf_job> job;
  std::optional<gonio::io::svbrdf_writer> map;
  Eigen::Index before = 0;
  std::uint32_t images = 0;
  processes.together([&] {
    job.emplace(options);
    if (!processes.is_alone()) images = job->checksum_of_images();
  });
  const auto header = job->header();
  processes.agree_on(header.prior_checksum, "prior");
  processes.agree_on(gonio::io::checksum_of(header), "list of images, --eta or --noise");
  processes.agree_on(images, "images");
  processes.together([&] {
    if (processes.writes()) before = open_map(map, *job, options.output);
  });
  progress_bar bar;
  processes.compute_in_order(
      {processes.number_of_writer(before), header.bands()}, [&](Eigen::Index band) { return job->band(header, band); },
      [&](Eigen::Index band, const team::part& bytes) {
        bar.draw("texels", static_cast<double>(band) / static_cast<double>(header.bands()));
        map->append(bytes);
      });
  processes.together([&] {
    if (!processes.writes()) return;
    map->commit();
    bar.wipe();
    write_arrays(options);
    print_done(header, before);
  });
}

}  // namespace

void add_svbrdf(command& app, const team& processes) {
  auto command = app.add_subcommand("svbrdf", "Complete a BRDF at each texel of registered images");
  const auto options = std::make_shared<svbrdf_command>();
  command
      .add_input("images", options->images,
                 "List of images (.json): for each a file (" + radiance_formats() +
                     ") and its directions; and the quantity of the values (docs/reference/formats.md)")
      .required();
  add_prior_option(command, options->prior);
  auto noise = command
                   .add_option("--noise", options->noise,
                               "Relative deviation of the images' values (0.02 is 2 %). Sets Tikhonov's penalty")
                   .check(check::range(0.0, 1.0))
                   .capture_default_str();
  command.add_option("--eta", options->eta, "Tikhonov's penalty, instead of --noise")
      .check(check::positive_number())
      .excludes(noise);
  command
      .add_output("-o,--output", options->output, {".gsv"},
                  "Map to write (.gsv). If the run is interrupted, the same command resumes it")
      .required();
  command.add_output("--weights", options->weights, {".npy"},
                     "Array to write of the map's weights: rows x columns x 3 x functions, half floats");
  command.add_output(
      "--functions", options->functions, {".npy"},
      "Array to write of the weights of the prior's components in each function: components x functions");
  command.add_output("--uncertainty", options->uncertainty, {".npy"},
                     "Array to write of each texel's relative standard deviation over all directions: 0.06 is 6 % (68 "
                     "of 100 cases); rows x columns");
  command.add_output("--disagreement", options->disagreement, {".npy"},
                     "Array to write of the disagreement of each texel's images: 1 is as expected; rows x columns");
  add_threads_option(command, options->threads);
  command.callback([options, &processes] { run(*options, processes); });
}

}  // namespace cli
