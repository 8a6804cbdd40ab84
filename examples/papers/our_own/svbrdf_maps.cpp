#include "papers/our_own/svbrdf_maps.hpp"

#include "tool/pages/contact_sheet.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/capture/k_means.hpp>
#include <gonio/core/half.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/render/exposure.hpp>
#include <gonio/render/false_colour.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/lighting.hpp>
#include <gonio/texels/texel_metric.hpp>

#include <algorithm>
#include <array>
#include <iostream>
#include <numbers>
#include <numeric>

namespace papers {

namespace {

/// The material assigned to each cluster, and the resulting share of correctly labelled texels.
struct cluster_names {
  std::vector<Eigen::Index> material;
  double right = 0.0;
};

/// Returns the best assignment of materials. `counts` is clusters x materials.
cluster_names best_names(const Eigen::MatrixXd& counts) {
  std::vector<Eigen::Index> material(static_cast<std::size_t>(counts.rows()));
  std::iota(material.begin(), material.end(), Eigen::Index{0});
  cluster_names best;
  do {
    double right = 0.0;
    for (Eigen::Index k = 0; k < counts.rows(); ++k) right += counts(k, material[static_cast<std::size_t>(k)]);
    if (right / counts.sum() > best.right) best = {material, right / counts.sum()};
  } while (std::ranges::next_permutation(material).found);
  return best;
}

double share_right(const Eigen::MatrixXd& counts) { return best_names(counts).right; }

/// Returns the radiance times pi of a flat sample under the two lights, seen from the normal.
template <class Brdf>
gonio::rgb lit(const Brdf& f) {
  gonio::rgb sum = gonio::rgb::Zero();
  const auto lighting = gonio::render::two_lights();
  for (const gonio::directional_light& light : lighting.lights())
    sum += std::numbers::pi * f(light.towards, gonio::direction(0, 0, 1)) * light.irradiance * light.towards.z();
  return sum;
}

}  // namespace

svbrdf_maps::svbrdf_maps(const gonio::log_relative_pca& prior, const gonio::io::svbrdf_map& map,
                         const synthetic_texels& texels, const std::vector<gonio::model::adaptive_brdf>& materials,
                         const std::filesystem::path& labels)
    : prior_(prior), map_(map), texels_(texels), materials_(materials) {
  const auto bytes = gonio::io::read_bytes(labels);
  const auto count = static_cast<std::size_t>(map.header().rows * map.header().columns);
  if (bytes.size() < count) gonio::refuse({labels.native(), ": has not a label for each texel"});
  for (const std::byte each : std::span(bytes).last(count)) labels_.push_back(std::to_integer<std::uint8_t>(each));
}

Eigen::Index svbrdf_maps::main_material(Eigen::Index row, Eigen::Index column) const {
  Eigen::Index most = 0;
  texels_.shares(row, column).maxCoeff(&most);
  return most;
}

void svbrdf_maps::print_labels(gonio::thread_count threads) const {
  const Eigen::Index size = map_.header().rows, count = std::ssize(materials_), r = map_.header().functions.cols();
  // Count all texels, and those in which one material has at least 90 %.
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(count, count), pure = all;
  for (Eigen::Index row = 0; row < size; ++row)
    for (Eigen::Index column = 0; column < size; ++column) {
      Eigen::Index most = 0;
      const double share = texels_.shares(row, column).maxCoeff(&most);
      all(label(row, column) - 1, most) += 1.0;
      if (share >= 0.9) pure(label(row, column) - 1, most) += 1.0;
    }
  std::cout << "| labelled by the material that a texel has most of | texels | right |\n|---|---|---|\n"
            << "| all | 100 % | " << cli::fixed(100.0 * share_right(all), 1) << " % |\n| nine tenths of one material | "
            << cli::fixed(100.0 * pure.sum() / all.sum(), 0) << " % | " << cli::fixed(100.0 * share_right(pure), 1)
            << " % |\n";
  // Repeat on 128 x 128 texels, also with plain distances of the weights.
  constexpr Eigen::Index across = 128;
  gonio::capture::point_matrix weights(across * across, 3 * r), mapped = weights;
  std::vector<Eigen::Index> truth, mostly_one;
  const Eigen::MatrixXf metric = gonio::texel_metric(prior_, map_.header().functions);
  for (Eigen::Index i = 0; i < across; ++i) {
    const Eigen::Index row = i * size / across;
    const auto band = map_.read_band(row / map_.header().band_rows);
    for (Eigen::Index j = 0; j < across; ++j) {
      const Eigen::Index column = j * size / across;
      const Eigen::Index texel = row % map_.header().band_rows * size + column;
      Eigen::MatrixXf own(r, 3);
      for (Eigen::Index w = 0; w < own.size(); ++w) own.data()[w] = gonio::from_half(band.weights[3 * r * texel + w]);
      const Eigen::MatrixXf moved = gonio::product(metric, own);
      weights.row(across * i + j) = Eigen::Map<const Eigen::RowVectorXf>(own.data(), 3 * r).cast<double>();
      mapped.row(across * i + j) = Eigen::Map<const Eigen::RowVectorXf>(moved.data(), 3 * r).cast<double>();
      truth.push_back(main_material(row, column));
      if (texels_.shares(row, column).maxCoeff() >= 0.9) mostly_one.push_back(across * i + j);
    }
  }
  std::vector<Eigen::Index> all_of_grid(truth.size());
  std::iota(all_of_grid.begin(), all_of_grid.end(), Eigen::Index{0});
  const auto right = [&](const gonio::capture::point_matrix& points, const std::vector<Eigen::Index>& some) {
    const gonio::capture::point_matrix own = points(some, Eigen::all);
    const auto found = gonio::capture::k_means(own, count, 1, threads);
    Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index i = 0; i < own.rows(); ++i)
      counts(found.labels[i], truth[static_cast<std::size_t>(some[static_cast<std::size_t>(i)])]) += 1.0;
    return cli::fixed(100.0 * share_right(counts), 1);
  };
  std::cout
      << "\n| k-means of 128 x 128 texels | by logarithms of reflectance | by weights as they are |\n|---|---|---|\n"
      << "| all | " << right(mapped, all_of_grid) << " % | " << right(weights, all_of_grid)
      << " % |\n| nine tenths of one material, alone | " << right(mapped, mostly_one) << " % | "
      << right(weights, mostly_one) << " % |\n\n";
}

gonio::image svbrdf_maps::figure(Eigen::Index size) const {
  const auto extent = static_cast<std::size_t>(size);
  std::array<gonio::image, 6> images;
  for (gonio::image& each : images) each = gonio::uniform_image(extent, extent);
  std::vector<gonio::rgb> seen;
  for (const auto& material : materials_) seen.push_back(lit(material));
  const Eigen::Index rows = map_.header().rows, band_rows = map_.header().band_rows;
  Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(std::ssize(materials_), std::ssize(materials_));
  for (Eigen::Index row = 0; row < rows; row += 8)
    for (Eigen::Index column = 0; column < rows; column += 8)
      counts(label(row, column) - 1, main_material(row, column)) += 1.0;
  const cluster_names names = best_names(counts);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::Index row = (2 * i + 1) * rows / (2 * size);
    const auto band = map_.read_band(row / band_rows);
    for (Eigen::Index j = 0; j < size; ++j) {
      const Eigen::Index column = (2 * j + 1) * rows / (2 * size), texel = row % band_rows * rows + column;
      const Eigen::VectorXd shares = texels_.shares(row, column);
      gonio::rgb truth = gonio::rgb::Zero();
      for (Eigen::Index m = 0; m < shares.size(); ++m) truth += shares[m] * seen[static_cast<std::size_t>(m)];
      const auto set = [&](std::size_t image, const gonio::rgb& colour) {
        gonio::set_pixel(images[image], static_cast<std::size_t>(i), static_cast<std::size_t>(j), colour);
      };
      set(0, truth);
      set(1, lit(gonio::fitted_brdf(prior_, gonio::io::weights_of_texel(map_.header(), band, texel))));
      set(3, gonio::render::category_colour(static_cast<int>(main_material(row, column))));
      set(4, gonio::render::sequential_colour(0.25 *
                                              gonio::from_half(band.disagreement[static_cast<std::size_t>(texel)])));
      set(5, gonio::render::category_colour(
                 static_cast<int>(names.material[static_cast<std::size_t>(label(row, column) - 1)])));
    }
  }
  const double exposure = gonio::render::exposure_of(images[0]);
  for (std::size_t each : {0u, 1u}) gonio::render::expose(images[each], exposure);
  double sum = 0.0;
  for (std::size_t i = 0; i < extent; ++i)
    for (std::size_t j = 0; j < extent; ++j) {
      const double difference = gonio::delta_e(gonio::pixel(images[0], i, j), gonio::pixel(images[1], i, j));
      gonio::set_pixel(images[2], i, j, gonio::render::sequential_colour(0.1 * difference));
      sum += difference;
    }
  std::cout << "Delta E of the flat sample under the two lights, seen from ahead: "
            << cli::fixed(sum / static_cast<double>(size * size), 2) << " on average over " << size << " x " << size
            << " texels.\n\n";
  return cli::contact_sheet(images, 3,
                            {{"truth", "estimate", "Delta E, light 0 to dark 10", "main material",
                              "disagreement, light 0 to dark 4", "clusters"},
                             {}});
}

}  // namespace papers
