/// gonio-papers svbrdf: runs gonio svbrdf on a synthetic sample of five measured materials. Reports time, memory,
/// colour differences, and interruptions.

#include "papers/experiments.hpp"
#include "papers/our_own/svbrdf_maps.hpp"
#include "papers/our_own/synthetic_texels.hpp"
#include "papers/our_own/tool_process.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/thinning.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/core/half.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/evaluate/sphere_delta_e.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/render/lighting.hpp>
#include <gonio/texels/texel_decomposition.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace papers {

namespace {

struct svbrdf_options {
  std::vector<std::filesystem::path> materials;
  std::filesystem::path prior, folder, image;
  Eigen::Index size = 4096, judged = 12;
  int kills = 20;
  double noise = 0.02;
  std::uint64_t seed = 1;
  gonio::thread_count threads;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Act>
double seconds_of(const Act& act) {
  const auto start = std::chrono::steady_clock::now();
  act();
  return seconds_since(start);
}

std::vector<std::string> words_of(const std::filesystem::path& images, const std::filesystem::path& map,
                                  const svbrdf_options& given) {
  return {"svbrdf",    images.string(),
          "-o",        map.string(),
          "--prior",   given.prior.string(),
          "--noise",   std::to_string(given.noise),
          "--threads", std::to_string(given.threads.resolve())};
}

bool same_bytes(const std::filesystem::path& one, const std::filesystem::path& other) {
  std::ifstream a(one, std::ios::binary), b(other, std::ios::binary);
  std::vector<char> of_a(1u << 20), of_b(1u << 20);
  while (true) {
    a.read(of_a.data(), static_cast<std::streamsize>(of_a.size()));
    b.read(of_b.data(), static_cast<std::streamsize>(of_b.size()));
    if (a.gcount() != b.gcount() || !std::equal(of_a.begin(), of_a.begin() + a.gcount(), of_b.begin())) return false;
    if (a.gcount() == 0) return true;
  }
}

// ---- the experiment ----------------------------------------------------------------------------

class svbrdf_experiment {
 public:
  explicit svbrdf_experiment(const svbrdf_options& given)
      : given_(given), prior_(gonio::io::read_prior(given.prior)), directions_(gonio::design::nielsen_directions(20)) {
    for (const auto& file : given.materials) materials_.push_back(gonio::io::read_rgl(file).material);
    std::vector<Eigen::MatrixXd> values;
    for (const auto& material : materials_) {
      Eigen::MatrixXd own(3, std::ssize(directions_));
      for (Eigen::Index i = 0; i < own.cols(); ++i) {
        const auto pair = gonio::to_directions(directions_[static_cast<std::size_t>(i)]);
        own.col(i) = material(pair.wi, pair.wo).matrix();
      }
      values.push_back(std::move(own));
    }
    texels_ = std::make_unique<synthetic_texels>(given.size, std::move(values), given.noise, given.seed);
    std::filesystem::create_directories(given.folder);
  }

  void run() {
    write_images();
    print_times();
    print_interruptions();
    print_errors();
    print_maps();
  }

 private:
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return given_.folder / name; }

  void write_images() const {
    gonio::for_each_index(
        std::ssize(directions_), 1,
        [&](Eigen::Index i) { texels_->write(file("image-" + std::to_string(i) + ".npy"), i); }, given_.threads);
    std::string list = "{\"quantity\": \"brdf\", \"images\": [";
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      const auto& at = directions_[i];
      list += std::string(i > 0 ? ",\n" : "\n") + "{\"image\": \"image-" + std::to_string(i) +
              ".npy\", \"theta_h\": " + fixed(gonio::degrees(at.theta_h), 6) +
              ", \"theta_d\": " + fixed(gonio::degrees(at.theta_d), 6) +
              ", \"phi_d\": " + fixed(gonio::degrees(at.phi_d), 6) + "}";
    }
    list += "]}\n";
    gonio::io::write_atomically(file("images.json"), std::as_bytes(std::span(list)));
  }

  [[nodiscard]] double seconds_of_reading() const {
    std::vector<char> bytes(1u << 20);
    return seconds_of([&] {
      for (std::size_t i = 0; i < directions_.size(); ++i) {
        std::ifstream image(file("image-" + std::to_string(i) + ".npy"), std::ios::binary);
        while (image.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
        }
      }
    });
  }

  void print_times() {
    const double reading = seconds_of_reading();
    std::filesystem::remove(file("map.gsv"));
    whole_ = run_tool(words_of(file("images.json"), file("map.gsv"), given_));
    const auto bytes = static_cast<double>(std::filesystem::file_size(file("map.gsv")));
    std::cout << given_.size << " x " << given_.size << " texels, " << directions_.size() << " images, "
              << prior_.size() << " components, noise of " << fixed(100.0 * given_.noise, 0) << " %, "
              << given_.threads.resolve() << " threads.\n\n| | |\n|---|---|\n| reading the images alone | "
              << fixed(reading, 1) << " s |\n| gonio svbrdf, reading included | " << fixed(whole_.seconds, 1)
              << " s |\n| its processor time | " << fixed(whole_.processor_seconds, 1)
              << " s |\n| its memory at most | " << fixed(whole_.megabytes, 0) << " MB |\n| the map | "
              << fixed(bytes * 1e-9, 2) << " GB |\n";
    print_product();
  }

  /// Compares the time to solve texels in memory with the time of large products of floats.
  void print_product() const {
    const Eigen::Index band = 16384;
    const gonio::io::svbrdf_map map(file("map.gsv"));
    const gonio::texel_decomposition estimator(prior_, locations(), gonio::tikhonov(map.header().eta));
    const Eigen::MatrixXf images = Eigen::MatrixXf::Constant(3 * band, std::ssize(directions_), 0.2f);
    const double solving = best_of([&] { static_cast<void>(estimator.solve(images, given_.threads)); });
    const auto found = estimator.solve(images, given_.threads);
    const double halves = best_of([&] { static_cast<void>(gonio::io::as_halves(found, given_.threads)); });
    const double operations =
        2.0 * static_cast<double>((estimator.functions().cols() + estimator.images()) * estimator.images() * 3 * band);
    const Eigen::MatrixXf left =
        Eigen::MatrixXf::Constant(estimator.functions().cols() + estimator.images(), estimator.images(), 0.5f);
    const Eigen::MatrixXf right = Eigen::MatrixXf::Constant(estimator.images(), 3 * 512, 0.5f);
    const double multiplying = best_of([&] {
      gonio::for_each_index(
          band / 512, 1, [&](Eigen::Index) { static_cast<void>(gonio::product(left, right)); }, given_.threads);
    });
    const Eigen::MatrixXf square = Eigen::MatrixXf::Constant(1024, 1024, 0.5f);
    const auto threads = static_cast<Eigen::Index>(given_.threads.resolve());
    const double limit = best_of([&] {
      gonio::for_each_index(
          threads, 1, [&](Eigen::Index) { static_cast<void>(gonio::product(square, square)); }, given_.threads);
    });
    const double rate = operations / solving, product_rate = operations / multiplying,
                 most = 2.0 * std::pow(1024.0, 3) * static_cast<double>(threads) / limit;
    const double bands = std::pow(static_cast<double>(given_.size), 2) / static_cast<double>(band);
    std::cout << "| solving alone | " << fixed(solving * bands, 1) << " s |\n| rounding to half floats alone | "
              << fixed(halves * bands, 1) << " s |\n| solving, multiplications and additions | "
              << fixed(rate * 1e-9, 1) << " GFLOP/s |\n| its product alone | " << fixed(product_rate * 1e-9, 1)
              << " GFLOP/s |\n| products of 1024 x 1024 floats | " << fixed(most * 1e-9, 1)
              << " GFLOP/s |\n| share of that limit, solving and its product | " << fixed(100.0 * rate / most, 0)
              << " %, " << fixed(100.0 * product_rate / most, 0) << " % |\n\n";
  }

  template <class Act>
  static double best_of(const Act& act) {
    double least = seconds_of(act);
    for (int again = 0; again < 4; ++again) least = std::min(least, seconds_of(act));
    return least;
  }

  /// Kills the tool `kills` times at random moments, and compares its final map with the uninterrupted run's.
  void print_interruptions() const {
    const std::filesystem::path again = file("again.gsv");
    std::filesystem::remove(again);
    std::filesystem::remove(file("again.gsv.part"));
    std::mt19937_64 generator(given_.seed);
    std::uniform_real_distribution<double> moment(0.05, std::max(whole_.seconds * 0.15, 0.5));
    int with_bands = 0;
    double seconds = 0.0;
    bool same = true;
    for (int killed = 0; killed < given_.kills;) {
      const process_cost cost = run_tool(words_of(file("images.json"), again, given_), moment(generator));
      seconds += cost.seconds;
      std::error_code none;
      if (cost.was_killed) {
        ++killed;
        if (std::filesystem::file_size(file("again.gsv.part"), none) > 65536 && !none) ++with_bands;
      } else {
        // If the tool finished before the wanted number of kills, begin once more.
        same = same && same_bytes(file("map.gsv"), again);
        std::filesystem::remove(again);
      }
    }
    seconds += run_tool(words_of(file("images.json"), again, given_)).seconds;
    same = same && same_bytes(file("map.gsv"), again);
    std::cout << "Killed " << given_.kills << " times at random moments, " << with_bands
              << " times with bands in the file, and given again each time: "
              << (same ? "the same bytes" : "OTHER BYTES") << ", " << fixed(seconds, 0) << " s in all.\n\n";
    std::filesystem::remove(again);
  }

  [[nodiscard]] std::vector<gonio::location> locations() const {
    std::vector<gonio::location> all;
    for (const auto& at : directions_) all.push_back(gonio::locate(prior_.cells(), at));
    return all;
  }

  /// Prints errors of texels on a grid: of spheres under the two lights, and relative to the stated uncertainty.
  void print_errors() const {
    const gonio::valid_cells cells = cli::thinning{{3, 5}}.of(gonio::valid_cells());
    std::vector<gonio::brdf_table> tables;
    for (const auto& material : materials_) tables.push_back(gonio::tabulate(material, cells, given_.threads));
    const gonio::sphere_delta_e judge(cells, gonio::render::two_lights(), 36, gonio::sphere_delta_e::middle_grey,
                                      given_.threads);
    const gonio::io::svbrdf_map map(file("map.gsv"));
    map.require_prior(prior_);
    const gonio::log_relative metric = prior_.metric().on(cells);
    std::vector<double> differences, ratios, errors, halves;
    for (Eigen::Index i = 0; i < given_.judged; ++i) {
      const Eigen::Index row = (2 * i + 1) * given_.size / (2 * given_.judged);
      const auto band = map.read_band(row / map.header().band_rows);
      for (Eigen::Index j = 0; j < given_.judged; ++j) {
        const Eigen::Index column = (2 * j + 1) * given_.size / (2 * given_.judged);
        const Eigen::Index texel = row % map.header().band_rows * given_.size + column;
        const auto weights = gonio::io::weights_of_texel(map.header(), band, texel);
        const auto estimate = gonio::fitted_brdf(prior_, weights).tabulate(cells, given_.threads);
        const auto truth = blended(tables, texels_->shares(row, column));
        differences.push_back(judge.difference(estimate, truth, given_.threads));
        errors.push_back(mapped_rms(estimate, truth, metric));
        ratios.push_back(errors.back() / gonio::from_half(band.uncertainty[static_cast<std::size_t>(texel)]));
        halves.push_back(gonio::from_half(band.disagreement[static_cast<std::size_t>(texel)]));
      }
    }
    print_row("Delta E under two lights", differences);
    print_row("error in the metric's domain, rms over directions", errors);
    print_row("the same over the stated uncertainty", ratios);
    print_row("disagreement", halves);
  }

  /// Prints the tool's clusters, and writes an image of the maps.
  void print_maps() const {
    const process_cost cost =
        run_tool({"texels", file("map.gsv").string(), "--prior", given_.prior.string(), "--clusters",
                  std::to_string(materials_.size()), "--labels", file("labels.npy").string(), "--threads",
                  std::to_string(given_.threads.resolve())});
    std::cout << "\n`gonio texels --clusters " << materials_.size() << "` takes " << fixed(cost.seconds, 1) << " s and "
              << fixed(cost.megabytes, 0) << " MB.\n\n";
    const gonio::io::svbrdf_map map(file("map.gsv"));
    const svbrdf_maps maps(prior_, map, *texels_, materials_, file("labels.npy"));
    maps.print_labels(given_.threads);
    if (!given_.image.empty())
      gonio::io::write_png(given_.image, maps.figure(std::min<Eigen::Index>(given_.size, 256)));
  }

  static gonio::brdf_table blended(const std::vector<gonio::brdf_table>& tables, const Eigen::VectorXd& shares) {
    std::vector<float> values(tables.front().values().size(), 0.0f);
    for (std::size_t m = 0; m < tables.size(); ++m)
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] += static_cast<float>(shares[static_cast<Eigen::Index>(m)]) * tables[m].values()[i];
    return {tables.front().cells(), std::move(values)};
  }

  static double mapped_rms(const gonio::brdf_table& estimate, const gonio::brdf_table& truth,
                           const gonio::log_relative& metric) {
    double squares = 0.0;
    for (Eigen::Index cell = 0; cell < truth.cells().size(); ++cell)
      for (Eigen::Index c = 0; c < 3; ++c)
        squares += std::pow(metric.forward(estimate.at(cell)[c], cell) - metric.forward(truth.at(cell)[c], cell), 2);
    return std::sqrt(squares / (3.0 * static_cast<double>(truth.cells().size())));
  }

  void print_row(const char* what, const std::vector<double>& values) const {
    if (header_)
      std::cout << "| " << values.size() << " texels | median | mean | 95th percentile |\n|---|---|---|---|\n";
    header_ = false;
    double sum = 0.0;
    for (const double each : values) sum += each;
    std::cout << "| " << what << " | " << fixed(gonio::median(std::vector(values)), 2) << " | "
              << fixed(sum / static_cast<double>(values.size()), 2) << " | "
              << fixed(gonio::quantile(std::vector(values), 0.95), 2) << " |\n";
  }

  const svbrdf_options& given_;
  gonio::log_relative_pca prior_;
  std::vector<gonio::half_difference> directions_;
  std::vector<gonio::model::adaptive_brdf> materials_;
  std::unique_ptr<synthetic_texels> texels_;
  process_cost whole_;
  mutable bool header_ = true;
};

}  // namespace

void add_svbrdf(command& app) {
  auto command = app.add_subcommand("svbrdf", "gonio svbrdf on a synthetic sample of measured materials");
  const auto options = std::make_shared<svbrdf_options>();
  command.add_input("--materials", options->materials, "Materials that the sample is made of (.bsdf)").required();
  add_prior_option(command, options->prior);
  command
      .add_output_folder("--folder", options->folder, {"images.json", "map.gsv", "again.gsv", "labels.npy"},
                         "Folder for the images and the maps, which takes 10 GB for 4096 x 4096 texels")
      .required();
  command.add_output("--image", options->image, {".png"},
                     "Image to write of the sample, its errors, and how well it is known");
  command.add_option("--size", options->size, "Rows and columns of texels").capture_default_str();
  command.add_option("--judged", options->judged, "Rows and columns of texels that are compared with the truth")
      .capture_default_str();
  command.add_option("--kills", options->kills, "How often the tool is killed").capture_default_str();
  command.add_option("--noise", options->noise, "Noise of the images, relative to their values").capture_default_str();
  command.add_option("--seed", options->seed, "Seed of the sample and its noise").capture_default_str();
  add_threads_option(command, options->threads);
  command.callback([options] {
    if (options->size < 1 || options->judged < 1) gonio::refuse("--size and --judged need at least 1");
    svbrdf_experiment(*options).run();
  });
}

}  // namespace papers
