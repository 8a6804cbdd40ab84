#pragma once
/// Bodies of capture/colour_clusters.hpp.

#include <gonio/capture/colour_clusters.hpp>
#include <gonio/capture/k_means.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/core/statistics.hpp>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace gonio::capture {

GONIO_INLINE std::vector<Eigen::Index> colour_clusters::pixels(Eigen::Index cluster) const {
  std::vector<Eigen::Index> found;
  for (Eigen::Index i = 0; i < labels.size(); ++i)
    if (labels[i] == cluster) found.push_back(i);
  return found;
}

}  // namespace gonio::capture

namespace gonio::capture::detail {

/// The number of pixels used to choose the number of clusters and their first centres.
inline constexpr Eigen::Index clustered_sample = 2000;

/// Returns the indices of `clustered_sample` random points of n, ascending; all indices if there are fewer points.
[[nodiscard]] GONIO_INLINE std::vector<Eigen::Index> some_points(Eigen::Index n, std::uint64_t seed) {
  const std::vector<Eigen::Index> chosen = random_choice(n, clustered_sample, seed);
  return {chosen.begin(), chosen.end()};
}

GONIO_INLINE void require_colours(const point_matrix_view& colours) {
  if (colours.rows() == 0 || colours.cols() != 3)
    refuse("clusters need at least one pixel of three numbers, not " + std::to_string(colours.rows()) + " x " +
           std::to_string(colours.cols()));
  for (Eigen::Index i = 0; i < colours.rows(); ++i)
    if (!colours.row(i).allFinite()) refuse("the colour of pixel " + std::to_string(i + 1) + " is not finite");
}

/// Assigns all points to the nearest of the clusters that were found for some of the points.
[[nodiscard]] GONIO_INLINE colour_clusters clusters_of_all(const point_matrix_view& colours, const point_matrix& points,
                                                           const std::vector<Eigen::Index>& some,
                                                           point_matrix first_centres, thread_count threads) {
  const point_clusters found = refine_clusters(points, std::move(first_centres), threads);
  point_matrix centres = cluster_means(colours, found.labels, found.centres.rows(), threads);
  const double silhouette = mean_silhouette(points(some, Eigen::all), found.labels(some), threads);
  return {found.labels, std::move(centres), found.sizes, silhouette, {}};
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE point_matrix clustering_coordinates(const point_matrix_view& colours) {
  detail::require_colours(colours);
  std::vector<double> largest(colours.rows());
  for (Eigen::Index i = 0; i < colours.rows(); ++i) largest[i] = colours.row(i).maxCoeff();
  const double white = quantile(largest, 0.99);
  if (!(white > 0.0)) refuse("99 of 100 pixels are black: there is no colour to cluster by");
  point_matrix coordinates(colours.rows(), 3);
  for (Eigen::Index i = 0; i < colours.rows(); ++i)
    coordinates.row(i) = to_lab(colours.row(i).transpose().array() / white).matrix().transpose();
  return coordinates;
}

GONIO_INLINE colour_clusters cluster_colours(const point_matrix_view& colours, Eigen::Index k, std::uint64_t seed,
                                             thread_count threads) {
  const point_matrix points = clustering_coordinates(colours);
  const std::vector<Eigen::Index> some = detail::some_points(points.rows(), seed);
  const point_matrix looked_at = points(some, Eigen::all);
  // If some colours are so rare that the sample has fewer than k, use all points.
  const bool enough = k < 1 || detail::different_points(looked_at, k) == k;
  point_clusters found = k_means(enough ? looked_at : points, k, seed, threads);
  return detail::clusters_of_all(colours, points, some, std::move(found.centres), threads);
}

GONIO_INLINE colour_clusters cluster_colours(const point_matrix_view& colours, const cluster_count_choice& choice,
                                             std::uint64_t seed, thread_count threads) {
  if (choice.most < 1) refuse("at least one cluster must be allowed, not " + std::to_string(choice.most));
  const point_matrix points = clustering_coordinates(colours);
  const std::vector<Eigen::Index> some = detail::some_points(points.rows(), seed);
  const point_matrix looked_at = points(some, Eigen::all);
  point_clusters best = k_means(looked_at, 1, seed, threads);
  std::vector<double> silhouettes{0.0};
  double largest = 0.0;
  for (Eigen::Index k = 2; k <= detail::different_points(looked_at, choice.most); ++k) {
    point_clusters found = k_means(looked_at, k, seed, threads);
    silhouettes.push_back(mean_silhouette(looked_at, found.labels, threads));
    if (!(silhouettes.back() > largest) || silhouettes.back() < choice.least_silhouette) continue;
    largest = silhouettes.back();
    best = std::move(found);
  }
  colour_clusters clusters = detail::clusters_of_all(colours, points, some, std::move(best.centres), threads);
  clusters.silhouettes = std::move(silhouettes);
  return clusters;
}

}  // namespace gonio::capture
