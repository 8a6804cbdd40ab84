#pragma once
/// Which pixels of a picture show the same material, told by their colours alone.
/// Xu, Nielsen, Yu, Jensen and Ramamoorthi, "Minimal BRDF Sampling for Two-Shot Near-Field Reflectance Acquisition",
/// SIGGRAPH Asia 2016, section 8 and Figure 17: with a fixed camera the pixels of both pictures are the same points of
/// a surface; the second, diffuse picture is clustered by colour and a BRDF estimated for each cluster. The paper names
/// neither the algorithm, nor the colour space, nor how many clusters are chosen: k-means, CIELAB and silhouettes are
/// ours.

#include <gonio/capture/k_means.hpp>
#include <gonio/core/rgb.hpp>

#include <vector>

namespace gonio {

/// The pixels of a picture by material.
struct colour_clusters {
  Eigen::VectorXi labels;          ///< for each pixel the number of its cluster, 0 the largest
  point_matrix centres;            ///< mean linear colour of each cluster, k x 3
  std::vector<std::size_t> sizes;  ///< how many pixels each cluster has
  /// How well the clusters stand apart, see `mean_silhouette`, by 2,000 of the pixels; 0 of one cluster.
  double silhouette = 0.0;
  /// The same of 1, 2, ... clusters before they were refined on all pixels, where their number was chosen.
  std::vector<double> silhouettes;

  [[nodiscard]] std::size_t count() const noexcept { return sizes.size(); }

  /// The pixels of a cluster, in their order.
  [[nodiscard]] std::vector<std::size_t> pixels(std::size_t cluster) const {
    std::vector<std::size_t> found;
    for (Eigen::Index i = 0; i < labels.size(); ++i)
      if (static_cast<std::size_t>(labels[i]) == cluster) found.push_back(static_cast<std::size_t>(i));
    return found;
  }
};

/// How the number of clusters is chosen: the one of 2 to `most` whose silhouette is largest, if that is
/// `least_silhouette` or more, otherwise one.
///
/// A silhouette does not tell whether one cluster is better than two. The default lies above what one material has that
/// is parted anyhow, be it noisy (0.4), or darkened irregularly (0.56) or evenly (0.64), and below what two materials
/// have whose colours are eight standard deviations of their noise apart: tests/capture/colour_clusters.cpp.
struct cluster_count_choice {
  Eigen::Index most = 6;
  double least_silhouette = 0.7;
};

namespace detail {

/// Pixels that the number of clusters and their first centres are found from.
inline constexpr std::size_t clustered_sample = 2000;

/// The positions of `clustered_sample` of n points at random, or of all if there are not as many, in their order.
[[nodiscard]] inline std::vector<Eigen::Index> some_points(Eigen::Index n, std::uint64_t seed) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(n)), chosen(std::min(all.size(), clustered_sample));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  std::mt19937_64 generator(seed);
  std::ranges::sample(all, chosen.begin(), std::ssize(chosen), generator);
  return chosen;
}

inline void require_colours(const point_matrix_view& colours) {
  if (colours.rows() == 0 || colours.cols() != 3)
    throw error("clusters need the colours of at least one pixel, three numbers each, not " +
                std::to_string(colours.rows()) + " times " + std::to_string(colours.cols()));
  for (Eigen::Index i = 0; i < colours.rows(); ++i)
    if (!colours.row(i).allFinite()) throw error("the colour of pixel " + std::to_string(i + 1) + " is not finite");
}

/// Carries clusters of some of the points over to all of them.
[[nodiscard]] inline colour_clusters clusters_of_all(const point_matrix_view& colours, const point_matrix& points,
                                                     const std::vector<Eigen::Index>& some, point_matrix first_centres,
                                                     thread_count threads) {
  const point_clusters found = refine_clusters(points, std::move(first_centres), threads);
  point_matrix centres = cluster_means(colours, found.labels, found.centres.rows(), threads);
  const double silhouette = mean_silhouette(points(some, Eigen::all), found.labels(some), threads);
  return {found.labels, std::move(centres), found.sizes, silhouette, {}};
}

}  // namespace detail

/// Where colours are compared: CIELAB of n linear Rec. 709 colours, n x 3, in which a distance is about what an
/// observer sees. Of any unit: they are exposed so that the largest channel of 99 of 100 pixels is at most 1, and
/// clipped above. Throws gonio::error if a colour is not finite, or none of these is brighter than black. O(n).
[[nodiscard]] inline point_matrix clustering_coordinates(const point_matrix_view& colours) {
  detail::require_colours(colours);
  std::vector<double> largest(static_cast<std::size_t>(colours.rows()));
  for (Eigen::Index i = 0; i < colours.rows(); ++i) largest[static_cast<std::size_t>(i)] = colours.row(i).maxCoeff();
  const auto white = largest.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(largest.size() - 1));
  std::ranges::nth_element(largest, white);
  if (!(*white > 0.0)) throw error("99 of 100 pixels are black: there is no colour to cluster by");
  point_matrix coordinates(colours.rows(), 3);
  for (Eigen::Index i = 0; i < colours.rows(); ++i)
    coordinates.row(i) = to_lab(colours.row(i).transpose().array() / *white).matrix().transpose();
  return coordinates;
}

/// Parts pixels into k clusters by k-means over their `clustering_coordinates`. Colours are linear Rec. 709, n x 3: of
/// a picture, or better the reflectances that were found from it, for where a light falls off towards the border it
/// darkens the same material. Centres come from 2,000 of the pixels, chosen by the seed, and are then refined on all.
/// Throws gonio::error if a colour is not finite, all are black, or fewer than k differ. The seed alone decides, not
/// the number of threads. O(n k) a step.
///
/// ```cpp
/// const auto materials = gonio::cluster_colours(second_picture, 3, seed);
/// for (std::size_t m = 0; m < materials.count(); ++m) estimate_from(materials.pixels(m));
/// ```
[[nodiscard]] inline colour_clusters cluster_colours(const point_matrix_view& colours, Eigen::Index k,
                                                     std::uint64_t seed, thread_count threads = {}) {
  const point_matrix points = clustering_coordinates(colours);
  const std::vector<Eigen::Index> some = detail::some_points(points.rows(), seed);
  const point_matrix looked_at = points(some, Eigen::all);
  // A colour may be so rare that none of the sample has it.
  const bool enough = k < 1 || detail::different_points(looked_at, k) == k;
  point_clusters found = k_means(enough ? looked_at : points, k, seed, threads);
  return detail::clusters_of_all(colours, points, some, std::move(found.centres), threads);
}

/// Parts pixels into as many clusters as stand apart best, and into one if none do. O(most 2,000^2) more. Throws
/// gonio::error as well unless `most` is at least 1.
[[nodiscard]] inline colour_clusters cluster_colours(const point_matrix_view& colours,
                                                     const cluster_count_choice& choice, std::uint64_t seed,
                                                     thread_count threads = {}) {
  if (choice.most < 1) throw error("at least one cluster must be allowed, not " + std::to_string(choice.most));
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

}  // namespace gonio
