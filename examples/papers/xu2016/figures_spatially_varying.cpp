/// Xu et al. 2016, Fig. 17: several materials in one flat sample, told apart by their colours. Simulated.

#include "lab/near_field_lab.hpp"
#include "papers/experiments.hpp"
#include "papers/material_result.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/xu2016/figures.hpp"
#include <gonio/capture/colour_clusters.hpp>
#include <gonio/capture/near_field_image.hpp>
#include <gonio/design/near_field_geometry.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/io/merl_directory.hpp>
#include <gonio/io/merl_gzip.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace papers::figures {

namespace {

constexpr Eigen::Index pixels_across = 96;
constexpr double noise_of_pixels = 0.02;

/// A material in the sample.
struct ingredient {
  std::string name;
  gonio::brdf_table truth;
};

/// The two images of a camera that stays; the second one is the diffuse one.
std::vector<gonio::capture::near_field_setup> two_setups() {
  const double field_of_view = gonio::radians(figures_field_of_view);
  std::vector<gonio::capture::near_field_setup> setups;
  for (const auto& [wi, wo] : shipped_poses("fixed-camera-25-2-expected-error"))
    setups.push_back({.camera = gonio::design::near_field_camera(wo, field_of_view, pixels_across),
                      .light = {wi},
                      .disc = gonio::capture::sample_disc{std::tan(field_of_view / 2.0)}});
  return setups;
}

/// Which of k materials each pixel of the region shows: square patches in diagonal rows, eight along the diameter.
Eigen::VectorXi patches(const gonio::capture::near_field_setup& setup, const std::vector<Eigen::Index>& region, int k) {
  const double side = setup.disc->radius / 4.0;
  const Eigen::Index columns = setup.camera.intrinsics().columns;
  Eigen::VectorXi labels(std::ssize(region));
  for (Eigen::Index i = 0; i < labels.size(); ++i) {
    const gonio::ray line = setup.camera.ray_through(static_cast<double>(region[i] % columns) + 0.5,
                                                     static_cast<double>(region[i] / columns) + 0.5);
    const auto point = line.at_ground();
    const auto patch = [&](double along) { return static_cast<int>(std::floor(along / side)) + 1000 * k; };
    labels[i] = (patch(point->x()) + patch(point->y())) % k;
  }
  return labels;
}

/// A sample of several materials: what was photographed, and which pixel shows which.
struct photographed_sample {
  std::vector<gonio::capture::near_field_setup> setups = two_setups();
  std::vector<Eigen::Index> region = gonio::capture::pixels_of_region(setups.back());
  Eigen::VectorXi labels = {};                        ///< of the region
  std::vector<std::vector<gonio::image>> alone = {};  ///< each material all over the sample: by image
  std::vector<gonio::image> images = {};

  /// Measurements in some of the region's pixels, of both images.
  [[nodiscard]] gonio::sample_set measured(const std::vector<gonio::image>& pictures,
                                           const std::vector<Eigen::Index>& chosen) const {
    gonio::sample_set all;
    for (std::size_t i = 0; i < setups.size(); ++i) {
      gonio::capture::near_field_setup setup = setups[i];
      setup.mask.assign(pixels_across * pixels_across, false);
      for (const Eigen::Index each : chosen) setup.mask[region[each]] = true;
      const auto samples = gonio::capture::near_field_samples(pictures[i], setup);
      all.insert(all.end(), samples.begin(), samples.end());
    }
    return all;
  }
};

photographed_sample photograph(const std::vector<ingredient>& materials, std::uint64_t seed) {
  photographed_sample sample;
  sample.labels = patches(sample.setups.back(), sample.region, static_cast<int>(materials.size()));
  for (const gonio::capture::near_field_setup& setup : sample.setups) {
    auto& pictures = sample.alone.emplace_back();
    for (const ingredient& material : materials)
      pictures.push_back(lab::photograph(material.truth, *setup.disc, setup, {.noise = noise_of_pixels}, ++seed));
    gonio::image& mixed = sample.images.emplace_back(pictures.front());
    for (Eigen::Index i = 0; i < sample.labels.size(); ++i) {
      const Eigen::Index row = sample.region[i] / pixels_across, column = sample.region[i] % pixels_across;
      gonio::set_pixel(mixed, row, column, gonio::pixel(pictures[sample.labels[i]], row, column));
    }
  }
  return sample;
}

/// Colours of the region's pixels in the second image.
gonio::capture::point_matrix colours_of(const photographed_sample& sample) {
  gonio::capture::point_matrix colours(std::ssize(sample.region), 3);
  for (Eigen::Index i = 0; i < colours.rows(); ++i)
    colours.row(i) =
        gonio::pixel(sample.images.back(), sample.region[i] / pixels_across, sample.region[i] % pixels_across)
            .matrix()
            .transpose();
  return colours;
}

/// How many pixels of each material (row) are in each cluster (column).
Eigen::MatrixXi overlap_of(const Eigen::VectorXi& labels, const gonio::capture::colour_clusters& clusters, int k) {
  Eigen::MatrixXi overlap = Eigen::MatrixXi::Zero(k, clusters.count());
  for (Eigen::Index i = 0; i < labels.size(); ++i) ++overlap(labels[i], clusters.labels[i]);
  return overlap;
}

/// The share of the pixels that are in a cluster which is mostly of their material.
double purity(const Eigen::MatrixXi& overlap) {
  return static_cast<double>(overlap.colwise().maxCoeff().sum()) / static_cast<double>(overlap.sum());
}

std::vector<Eigen::Index> pixels_with(const Eigen::VectorXi& labels, Eigen::Index label) {
  std::vector<Eigen::Index> found;
  for (Eigen::Index i = 0; i < labels.size(); ++i)
    if (labels[i] == label) found.push_back(i);
  return found;
}

/// Where all samples of one database end up.
struct report {
  table clusters{"Samples, and their clusters",
                 {{"sample"},
                  {"pixels", 0},
                  {"purity of as many clusters as materials"},
                  {"clusters, if nobody says how many", 0},
                  {"their purity"}}};
  table errors{"Each material from the cluster that has most of its pixels, from its true pixels, and if it were alone",
               {{"sample"},
                {"material"},
                {"mapped error"},
                {"Delta E env: cluster", 2},
                {"true pixels", 2},
                {"alone", 2},
                {"Delta E lights: cluster", 2},
                {"true pixels", 2},
                {"alone", 2}}};
};

/// The tools that estimates are made and judged with.
struct judge {
  const gonio::log_relative_pca& prior;
  const gonio::appearance_metric& appearance;
  double eta;
  gonio::thread_count threads;

  [[nodiscard]] gonio::comparison operator()(const gonio::sample_set& samples, const gonio::brdf_table& truth) const {
    const auto estimate =
        gonio::decomposition{prior, gonio::tikhonov{eta}}.fit(samples).tabulate(truth.cells(), threads);
    return gonio::compare(estimate, truth, prior.metric(), appearance, threads);
  }
};

void add_sample(report& shown, const std::string& name, const std::vector<ingredient>& materials, const judge& judged,
                std::uint64_t seed) {
  const int k = static_cast<int>(materials.size());
  const photographed_sample sample = photograph(materials, seed);
  const gonio::capture::point_matrix colours = colours_of(sample);
  const auto known = gonio::capture::cluster_colours(colours, k, seed, judged.threads);
  const auto chosen =
      gonio::capture::cluster_colours(colours, gonio::capture::cluster_count_choice{}, seed, judged.threads);
  const Eigen::MatrixXi overlap = overlap_of(sample.labels, known, k);
  shown.clusters.rows.push_back(
      {name, sample.region.size(), purity(overlap), chosen.count(), purity(overlap_of(sample.labels, chosen, k))});
  for (int m = 0; m < k; ++m) {
    const gonio::brdf_table& truth = materials[m].truth;
    Eigen::Index cluster = 0;
    overlap.row(m).maxCoeff(&cluster);
    const std::vector<Eigen::Index> own = pixels_with(sample.labels, m);
    std::vector<gonio::image> alone;
    for (const auto& pictures : sample.alone) alone.push_back(pictures[m]);
    std::vector<Eigen::Index> everywhere(sample.region.size());
    std::iota(everywhere.begin(), everywhere.end(), Eigen::Index{0});
    const auto by_cluster = judged(sample.measured(sample.images, known.pixels(cluster)), truth);
    const auto by_own = judged(sample.measured(sample.images, own), truth);
    const auto by_itself = judged(sample.measured(alone, everywhere), truth);
    shown.errors.rows.push_back({name, materials[m].name, by_cluster.mapped_rms.mean(), by_cluster.delta_e_env,
                                 by_own.delta_e_env, by_itself.delta_e_env, by_cluster.delta_e_lights,
                                 by_own.delta_e_lights, by_itself.delta_e_lights});
  }
}

/// The means over all rows of errors, as its last row.
void add_mean(table& errors) {
  std::vector<json> mean{"mean", ""};
  for (std::size_t column = 2; column < errors.columns.size(); ++column) {
    double sum = 0.0;
    for (const auto& row : errors.rows) sum += row[column].number();
    mean.emplace_back(sum / static_cast<double>(errors.rows.size()));
  }
  errors.rows.push_back(std::move(mean));
}

/// Samples of two and of three of some materials, each material in one of either.
template <class Read>
tables samples_of_each(const std::string& database, const options& given, const gonio::log_relative_pca& prior,
                       std::size_t count, Read&& read, const gonio::progress& listener) {
  report shown;
  std::optional<gonio::appearance_metric> appearance;
  for (const std::size_t k : {2, 3})
    for (std::size_t first = 0; first + k <= count; first += k) {
      std::vector<ingredient> materials;
      for (std::size_t m = first; m < first + k; ++m) materials.push_back(read(m));
      const std::string name = std::to_string(k) + " materials, " + std::to_string(first / k + 1);
      gonio::report(listener, database + ", " + name, static_cast<double>(first) / static_cast<double>(count));
      if (!appearance) appearance.emplace(materials.front().truth.cells(), 36, given.threads);
      add_sample(shown, name, materials, {prior, *appearance, given.eta, given.threads}, given.seed);
    }
  if (shown.errors.rows.empty()) gonio::refuse("figure 2016-17 needs at least two materials: " + database);
  add_mean(shown.errors);
  shown.clusters.title = database + ": " + shown.clusters.title;
  shown.errors.title = database + ": " + shown.errors.title;
  return {std::move(shown.clusters), std::move(shown.errors)};
}

}  // namespace

tables xu_17(const options& given, const gonio::progress& listener) {
  const auto split = nielsen_split::learn(given.networks, given.threads, listener);
  const std::size_t most = given.up_to(10);
  tables shown = samples_of_each(
      "Surrogates", given, split.prior, std::min(most, split.truths.names.size()),
      [&](std::size_t m) {
        return ingredient{split.truths.names[m], split.truths.table(m)};
      },
      listener);
  if (given.measured_tables.empty()) return shown;
  const auto files = gonio::io::list_merl_directory(given.measured_tables);
  tables measured = samples_of_each(
      "Measured tables", given, split.prior, std::min(most, files.size()),
      [&](std::size_t m) {
        return ingredient{files[m].name, gonio::io::read_merl_any(files[m].path)};
      },
      listener);
  shown.insert(shown.end(), std::make_move_iterator(measured.begin()), std::make_move_iterator(measured.end()));
  return shown;
}

}  // namespace papers::figures
