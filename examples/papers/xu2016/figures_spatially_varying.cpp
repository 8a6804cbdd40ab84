/// Xu et al. 2016, Fig. 17: simulates a flat sample of several materials, separated by their colours.

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
#include <gonio/io/materials/merl_directory.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace papers::figures {

namespace {

constexpr Eigen::Index pixels_across = 96;
constexpr double noise_of_pixels = 0.02;
/// Rays along each side of a pixel: a pixel on a boundary mixes two materials.
constexpr Eigen::Index rays_across = 3;

struct ingredient {
  std::string name;
  gonio::brdf_table truth;
};

/// Returns the setups of two images with a fixed camera; the second image shows diffuse reflection.
std::vector<gonio::capture::near_field_setup> two_setups(Eigen::Index pixels) {
  const double field_of_view = gonio::radians(figures_field_of_view);
  std::vector<gonio::capture::near_field_setup> setups;
  for (const auto& [wi, wo] : shipped_poses("fixed-camera-25-2-expected-error"))
    setups.push_back({.camera = gonio::design::near_field_camera(wo, field_of_view, pixels),
                      .light = gonio::directional_light{wi},
                      .disc = gonio::capture::sample_disc{std::tan(field_of_view / 2.0)}});
  return setups;
}

/// Returns which of k materials is at a pixel's centre: square patches in diagonal rows, eight along the diameter.
int patch_of(const gonio::capture::near_field_setup& setup, Eigen::Index row, Eigen::Index column, int k) {
  const gonio::ray line = setup.camera.ray_through(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
  const auto point = line.at_ground();
  const double side = setup.disc->radius / 4.0;
  const auto number = [&](double along) { return static_cast<int>(std::floor(along / side)) + 1000 * k; };
  return point ? (number(point->x()) + number(point->y())) % k : 0;
}

/// Returns an image of the means over blocks of pixels.
gonio::image averaged(const gonio::image& fine) {
  gonio::image coarse = gonio::uniform_image(pixels_across, pixels_across);
  for (Eigen::Index row = 0; row < pixels_across; ++row)
    for (Eigen::Index column = 0; column < pixels_across; ++column) {
      gonio::rgb sum = gonio::rgb::Zero();
      for (Eigen::Index ray = 0; ray < rays_across * rays_across; ++ray)
        sum += gonio::pixel(fine, row * rays_across + ray / rays_across, column * rays_across + ray % rays_across);
      gonio::set_pixel(coarse, row, column, sum / static_cast<double>(rays_across * rays_across));
    }
  return coarse;
}

/// A sample of several materials: its photographs, and the material of each pixel.
struct photographed_sample {
  std::vector<gonio::capture::near_field_setup> setups = two_setups(pixels_across);
  std::vector<Eigen::Index> region = gonio::capture::pixels_of_region(setups.back());
  Eigen::VectorXi labels = {};  ///< material of each of the region's pixels
  /// For each image and material: a photograph of a sample of this material alone.
  std::vector<std::vector<gonio::image>> alone = {};
  std::vector<gonio::image> images = {};

  /// Returns the measurements of both images at the `chosen` pixels of the region.
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

photographed_sample photograph(const std::vector<const ingredient*>& materials, std::uint64_t seed) {
  const int k = static_cast<int>(materials.size());
  photographed_sample sample;
  sample.labels.resize(std::ssize(sample.region));
  for (Eigen::Index i = 0; i < sample.labels.size(); ++i)
    sample.labels[i] =
        patch_of(sample.setups.back(), sample.region[i] / pixels_across, sample.region[i] % pixels_across, k);
  for (const gonio::capture::near_field_setup& setup : two_setups(rays_across * pixels_across)) {
    // Extend the sample past the region, so that the region's pixels see only the sample.
    const gonio::capture::sample_disc disc{1.5 * setup.disc->radius};
    const double noise = noise_of_pixels * static_cast<double>(rays_across);
    std::vector<gonio::image> pictures;
    auto& alone = sample.alone.emplace_back();
    for (const ingredient* material : materials) {
      pictures.push_back(lab::photograph(material->truth, disc, setup, {.noise = noise}, ++seed));
      alone.push_back(averaged(pictures.back()));
    }
    gonio::image mixed = pictures.front();
    for (Eigen::Index row = 0; row < rays_across * pixels_across; ++row)
      for (Eigen::Index column = 0; column < rays_across * pixels_across; ++column)
        gonio::set_pixel(mixed, row, column, gonio::pixel(pictures[patch_of(setup, row, column, k)], row, column));
    sample.images.push_back(averaged(mixed));
  }
  return sample;
}

/// Returns the colours of the region's pixels in the second image.
gonio::capture::point_matrix colours_of(const photographed_sample& sample) {
  gonio::capture::point_matrix colours(std::ssize(sample.region), 3);
  for (Eigen::Index i = 0; i < colours.rows(); ++i)
    colours.row(i) =
        gonio::pixel(sample.images.back(), sample.region[i] / pixels_across, sample.region[i] % pixels_across)
            .matrix()
            .transpose();
  return colours;
}

/// Returns the number of pixels of each material (row) in each cluster (column).
Eigen::MatrixXi overlap_of(const Eigen::VectorXi& labels, const gonio::capture::colour_clusters& clusters, int k) {
  Eigen::MatrixXi overlap = Eigen::MatrixXi::Zero(k, clusters.count());
  for (Eigen::Index i = 0; i < labels.size(); ++i) ++overlap(labels[i], clusters.labels[i]);
  return overlap;
}

/// Returns the share of pixels that have the main material of their cluster.
double purity(const Eigen::MatrixXi& overlap) {
  return static_cast<double>(overlap.colwise().maxCoeff().sum()) / static_cast<double>(overlap.sum());
}

std::vector<Eigen::Index> pixels_with(const Eigen::VectorXi& labels, Eigen::Index label) {
  std::vector<Eigen::Index> found;
  for (Eigen::Index i = 0; i < labels.size(); ++i)
    if (labels[i] == label) found.push_back(i);
  return found;
}

/// The tables that collect all samples of one database.
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

/// Reconstructs a material, and compares it with the truth.
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

void add_sample(report& shown, const std::string& name, const std::vector<const ingredient*>& materials,
                const judge& judged, std::uint64_t seed) {
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
    const gonio::brdf_table& truth = materials[m]->truth;
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
    shown.errors.rows.push_back({name, materials[m]->name, by_cluster.mapped_rms.mean(), by_cluster.delta_e_env,
                                 by_own.delta_e_env, by_itself.delta_e_env, by_cluster.delta_e_lights,
                                 by_own.delta_e_lights, by_itself.delta_e_lights});
  }
}

void add_mean(table& errors) {
  std::vector<json> mean{"mean", ""};
  for (std::size_t column = 2; column < errors.columns.size(); ++column) {
    double sum = 0.0;
    for (const auto& row : errors.rows) sum += row[column].number();
    mean.emplace_back(sum / static_cast<double>(errors.rows.size()));
  }
  errors.rows.push_back(std::move(mean));
}

/// Tabulates how well clusters separate each pair of materials.
table all_pairs(const std::vector<ingredient>& materials, const options& given) {
  struct pair_purity {
    double purity = 0.0;
    std::string names;
  };
  std::vector<pair_purity> pairs;
  for (std::size_t a = 0; a < materials.size(); ++a)
    for (std::size_t b = a + 1; b < materials.size(); ++b) {
      const photographed_sample sample = photograph({&materials[a], &materials[b]}, given.seed);
      const auto clusters = gonio::capture::cluster_colours(colours_of(sample), 2, given.seed, given.threads);
      pairs.push_back({purity(overlap_of(sample.labels, clusters, 2)), materials[a].name + ", " + materials[b].name});
    }
  std::ranges::sort(pairs, {}, &pair_purity::purity);
  const auto pure = std::ranges::count_if(pairs, [](const pair_purity& pair) { return pair.purity >= 0.95; });
  return {"Purity of two clusters, of each two materials",
          {{"pairs", 0}, {"95 % and more", 0}, {"median"}, {"lowest"}, {"of"}},
          {{pairs.size(), pure, pairs[pairs.size() / 2].purity, pairs.front().purity, pairs.front().names}}};
}

/// Combines materials into samples of two materials and of three. A material is in at most one sample of each kind.
tables samples_of_each(const std::string& database, const options& given, const gonio::log_relative_pca& prior,
                       const std::vector<ingredient>& materials, const gonio::progress& listener) {
  if (materials.size() < 2) gonio::refuse("figure 2016-17 needs at least two materials: " + database);
  report shown;
  const gonio::appearance_metric appearance(materials.front().truth.cells(), 36, given.threads);
  for (const std::size_t k : {2, 3})
    for (std::size_t first = 0; first + k <= materials.size(); first += k) {
      std::vector<const ingredient*> chosen;
      for (std::size_t m = first; m < first + k; ++m) chosen.push_back(&materials[m]);
      const std::string name = std::to_string(k) + " materials, " + std::to_string(first / k + 1);
      gonio::report(listener, database + ", " + name,
                    static_cast<double>(first) / static_cast<double>(materials.size()));
      add_sample(shown, name, chosen, {prior, appearance, given.eta, given.threads}, given.seed);
    }
  add_mean(shown.errors);
  tables all{all_pairs(materials, given), std::move(shown.clusters), std::move(shown.errors)};
  for (table& one : all) one.title = database + ": " + one.title;
  return all;
}

}  // namespace

tables xu_17(const options& given, const gonio::progress& listener) {
  const auto split = nielsen_split::learn(given.networks, given.threads, listener, given.weighting);
  const auto chosen = [&](std::size_t all) { return std::min(all, given.up_to(10)); };
  std::vector<ingredient> surrogates, measured;
  for (std::size_t m = 0; m < chosen(split.truths.names.size()); ++m)
    surrogates.push_back({split.truths.names[m], split.truths.table(m)});
  tables shown = samples_of_each("Surrogates", given, split.prior, surrogates, listener);
  if (given.measured_tables.empty()) return shown;
  const auto files = gonio::io::list_merl_directory(given.measured_tables);
  for (std::size_t m = 0; m < chosen(files.size()); ++m)
    measured.push_back({files[m].name, gonio::io::read_merl_any(files[m].path)});
  tables more = samples_of_each("Measured tables", given, split.prior, measured, listener);
  shown.insert(shown.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  return shown;
}

}  // namespace papers::figures
