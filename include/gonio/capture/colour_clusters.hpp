#pragma once
/// Which pixels of an image show the same material, told by their colours alone.
/// Xu, Nielsen, Yu, Jensen and Ramamoorthi, "Minimal BRDF Sampling for Two-Shot Near-Field Reflectance Acquisition",
/// SIGGRAPH Asia 2016 (doi:10.1145/2980179.2982396), section 8 and Figure 17: with a fixed camera the pixels of both
/// images are the same points of a surface; the second, diffuse image is clustered by colour and a BRDF estimated for
/// each cluster. The paper names neither the algorithm, nor the colour space, nor how many clusters are chosen:
/// k-means, CIELAB and silhouettes are ours.

#include <gonio/capture/k_means.hpp>
#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace gonio::capture {

/// The pixels of an image by material.
struct colour_clusters {
  Eigen::VectorXi labels;           ///< for each pixel the number of its cluster, 0 the largest
  point_matrix centres;             ///< mean linear colour of each cluster, k x 3
  std::vector<Eigen::Index> sizes;  ///< how many pixels each cluster has
  /// How well the clusters stand apart, see `mean_silhouette`, by 2,000 of the pixels; 0 of one cluster.
  double silhouette = 0.0;
  /// The same of 1, 2, ... clusters before they were refined on all pixels, where their number was chosen.
  std::vector<double> silhouettes;

  [[nodiscard]] Eigen::Index count() const noexcept { return sizes.size(); }

  /// The pixels of a cluster, in their order.
  [[nodiscard]] std::vector<Eigen::Index> pixels(Eigen::Index cluster) const;
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

/// Where colours are compared: CIELAB of n linear Rec. 709 colours, n x 3, in which a distance is about what an
/// observer sees. Of any unit: they are exposed so that the largest channel of 99 of 100 pixels is at most 1, and
/// clipped above. Throws gonio::error if a colour is not finite, or none of these is brighter than black. O(n).
[[nodiscard]] point_matrix clustering_coordinates(const point_matrix_view& colours);

/// Parts pixels into k clusters by k-means over their `clustering_coordinates`. Colours are linear Rec. 709, n x 3: of
/// an image, or better the reflectances that were found from it, for where a light falls off towards the border it
/// darkens the same material. Centres come from 2,000 of the pixels, chosen by the seed, and are then refined on all.
/// Throws gonio::error if a colour is not finite, all are black, or fewer than k differ. The seed alone decides, not
/// the number of threads. O(n k) a step.
///
/// ```cpp
/// const auto materials = gonio::capture::cluster_colours(second_image, 3, seed);
/// for (Eigen::Index m = 0; m < materials.count(); ++m) estimate_from(materials.pixels(m));
/// ```
[[nodiscard]] colour_clusters cluster_colours(const point_matrix_view& colours, Eigen::Index k, std::uint64_t seed,
                                              thread_count threads = {});

/// Parts pixels into as many clusters as stand apart best, and into one if none do. O(most 2,000^2) more. Throws
/// gonio::error as well unless `most` is at least 1.
[[nodiscard]] colour_clusters cluster_colours(const point_matrix_view& colours, const cluster_count_choice& choice,
                                              std::uint64_t seed, thread_count threads = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/colour_clusters.ipp>
#endif
