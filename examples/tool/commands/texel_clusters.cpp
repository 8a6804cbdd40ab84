#include "texel_clusters.hpp"

#include <gonio/core/error.hpp>
#include <gonio/core/half.hpp>
#include <gonio/core/random.hpp>
#include <gonio/solve/float_product.hpp>
#include <gonio/texels/texel_metric.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace cli {

namespace {

constexpr Eigen::Index looked_at = 16384;

/// Returns the `own` weights of each of some texels of a band: own x texels.
Eigen::MatrixXf weights_of(const gonio::io::svbrdf_band& band, const std::vector<Eigen::Index>& texels,
                           Eigen::Index own) {
  Eigen::MatrixXf weights(own, std::ssize(texels));
  for (Eigen::Index i = 0; i < weights.cols(); ++i) {
    const std::uint16_t* stored = band.weights.data() + own * texels[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < own; ++j) weights(j, i) = gonio::from_half(stored[j]);
  }
  return weights;
}

/// Returns a point for each texel, one per row. The distance of two points is the distance of their texels.
gonio::capture::point_matrix points_of(const Eigen::MatrixXf& metric, const Eigen::MatrixXf& weights) {
  const Eigen::Index r = metric.cols();
  const Eigen::Map<const Eigen::MatrixXf> channels(weights.data(), r, weights.size() / r);
  const Eigen::MatrixXf moved = gonio::product(metric, channels);
  return Eigen::Map<const Eigen::MatrixXf>(moved.data(), weights.rows(), weights.cols()).transpose().cast<double>();
}

/// Returns one random texel from each of `looked_at` equal ranges, in order, or all texels if there are fewer.
std::vector<Eigen::Index> some_texels(Eigen::Index all, std::uint64_t seed) {
  const Eigen::Index count = std::min(all, looked_at);
  std::mt19937_64 generator(seed);
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index first = i * all / count, end = (i + 1) * all / count;
    const double along = gonio::uniform_number(generator) * static_cast<double>(end - first);
    chosen.push_back(std::min(first + static_cast<Eigen::Index>(along), end - 1));
  }
  return chosen;
}

gonio::capture::point_matrix some_points(const gonio::io::svbrdf_map& map, const Eigen::MatrixXf& metric,
                                         std::uint64_t seed) {
  const gonio::io::svbrdf_header& header = map.header();
  const Eigen::Index own = 3 * metric.cols();
  const std::vector<Eigen::Index> chosen = some_texels(header.rows * header.columns, seed);
  gonio::capture::point_matrix points(std::ssize(chosen), own);
  Eigen::Index used = 0, first = 0;
  auto next = chosen.begin();
  for (Eigen::Index number = 0; number < header.bands(); ++number) {
    const Eigen::Index end = first + header.texels_of_band(number);
    if (next != chosen.end() && *next < end) {
      const gonio::io::svbrdf_band band = map.read_band(number);
      std::vector<Eigen::Index> here;
      for (; next != chosen.end() && *next < end; ++next)
        if (band.has_material(*next - first)) here.push_back(*next - first);
      points.middleRows(used, std::ssize(here)) = points_of(metric, weights_of(band, here, own));
      used += std::ssize(here);
    }
    first = end;
  }
  points.conservativeResize(used, own);
  return points;
}

}  // namespace

double texel_clusters::cluster::distance() const { return std::sqrt(squared_distances / std::max(texels, 1.0)); }

texel_clusters::texel_clusters(const gonio::io::svbrdf_map& map, const gonio::log_relative_pca& prior,
                               Eigen::Index clusters, std::uint64_t seed, gonio::thread_count threads)
    : map_(map), threads_(threads) {
  map.require_prior(prior);
  metric_ = gonio::texel_metric(prior, map.header().functions);
  const gonio::capture::point_matrix points = some_points(map, metric_, seed);
  try {
    centres_ = gonio::capture::k_means(points, clusters, seed, threads).centres;
  } catch (const gonio::error& error) {
    gonio::refuse({"--clusters ", clusters, ": ", error.what()});
  }
  summary_.resize(static_cast<std::size_t>(clusters));
  for (cluster& each : summary_) each.weights = Eigen::VectorXd::Zero(3 * metric_.cols());
}

std::vector<std::uint8_t> texel_clusters::assign(const gonio::io::svbrdf_band& band) {
  std::vector<Eigen::Index> material;
  for (Eigen::Index texel = 0; texel < std::ssize(band.uncertainty); ++texel)
    if (band.has_material(texel)) material.push_back(texel);
  const Eigen::MatrixXf weights = weights_of(band, material, 3 * metric_.cols());
  const auto nearest = gonio::capture::find_nearest(points_of(metric_, weights), centres_, threads_);
  std::vector<std::uint8_t> labels(band.uncertainty.size());
  for (Eigen::Index i = 0; i < weights.cols(); ++i)
    labels[static_cast<std::size_t>(material[static_cast<std::size_t>(i)])] =
        static_cast<std::uint8_t>(nearest.labels[i] + 1);
  // One task per cluster, so that sums do not depend on the number of threads.
  gonio::for_each_index(
      count(), 1,
      [&](Eigen::Index k) {
        cluster& own = summary_[static_cast<std::size_t>(k)];
        for (Eigen::Index i = 0; i < weights.cols(); ++i) {
          if (nearest.labels[i] != k) continue;
          own.texels += 1.0;
          own.squared_distances += nearest.squared_distances[i];
          own.weights += weights.col(i).cast<double>();
        }
      },
      threads_);
  return labels;
}

Eigen::MatrixXd texel_clusters::mean_weights(Eigen::Index number) const {
  const cluster& own = summary_.at(static_cast<std::size_t>(number));
  const Eigen::MatrixXf& functions = map_.header().functions;
  const Eigen::VectorXd mean = own.weights / std::max(own.texels, 1.0);
  return functions.cast<double>() * Eigen::Map<const Eigen::MatrixXd>(mean.data(), functions.cols(), 3);
}

}  // namespace cli
