#pragma once
/// Groups the pixels of an image by material, from their colours alone. Xu, Nielsen, Yu, Jensen and Ramamoorthi,
/// "Minimal BRDF Sampling for Two-Shot Near-Field Reflectance Acquisition", SIGGRAPH Asia 2016
/// (doi:10.1145/2980179.2982396), section 8 and Figure 17: the camera is fixed, so the pixels of the two images show
/// the same surface points. The second image, without highlights, is clustered by colour, and a BRDF is estimated for
/// each cluster. The paper does not specify the algorithm, the colour space or the choice of the number of clusters. We
/// use k-means, CIELAB and silhouettes.

#include <gonio/capture/k_means.hpp>
#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace gonio::capture {

/// The pixels of an image, grouped by material.
struct colour_clusters {
  Eigen::VectorXi labels;           ///< the cluster of each pixel; 0 is the largest cluster
  point_matrix centres;             ///< mean linear colour of each cluster, k x 3
  std::vector<Eigen::Index> sizes;  ///< number of pixels of each cluster
  /// Separation of the clusters (see `mean_silhouette`), measured on 2,000 of the pixels; 0 for a single cluster.
  double silhouette = 0.0;
  /// Separations of the same 2,000 pixels in 1, 2, ... clusters, by which the number of clusters was chosen.
  std::vector<double> silhouettes;

  [[nodiscard]] Eigen::Index count() const noexcept { return sizes.size(); }

  /// Returns the pixels of a cluster, in ascending order.
  [[nodiscard]] std::vector<Eigen::Index> pixels(Eigen::Index cluster) const;
};

/// The rule for the number of clusters: the number from 2 to `most` with the largest silhouette, if that silhouette is
/// at least `least_silhouette`, otherwise one.
///
/// A silhouette cannot compare one cluster with two. If one material is split arbitrarily, the silhouette is 0.4 for a
/// noisy colour, 0.56 for irregular darkening and 0.64 for even darkening. The default of `least_silhouette` is higher.
/// The default is below the silhouette of two materials whose colours are eight standard deviations of their noise
/// apart: tests/capture/colour_clusters.cpp.
struct cluster_count_choice {
  Eigen::Index most = 6;
  double least_silhouette = 0.7;
};

/// Returns the CIELAB coordinates of n linear Rec. 709 colours, n x 3, for clustering. Distances approximate visible
/// differences. Colours may have any unit: they are scaled so that the largest channel of 99 % of the pixels is at most
/// 1, and clipped above 1. Throws gonio::error if a colour is not finite, or if 99 % are black. O(n).
[[nodiscard]] point_matrix clustering_coordinates(const point_matrix_view& colours);

/// Splits pixels into k clusters by k-means over their `clustering_coordinates`. Colours are linear Rec. 709, n x 3:
/// the pixels' values or, better, their reflectances, because a light's falloff darkens parts of the same material.
/// Finds centres from 2,000 of the pixels, chosen by the seed, and refines them on all pixels. Throws gonio::error if a
/// colour is not finite, if all are black, or if fewer than k differ. The result depends on the seed, not on the number
/// of threads. O(n k) per step.
///
/// ```cpp
/// const auto materials = gonio::capture::cluster_colours(second_image, 3, seed);
/// for (Eigen::Index m = 0; m < materials.count(); ++m) estimate_from(materials.pixels(m));
/// ```
[[nodiscard]] colour_clusters cluster_colours(const point_matrix_view& colours, Eigen::Index k, std::uint64_t seed,
                                              thread_count threads = {});

/// Splits pixels into the number of clusters with the best separation, or one if they do not separate. In addition to
/// the overload for k clusters, costs O(most 2,000^2) and throws gonio::error unless `most` is at least 1.
[[nodiscard]] colour_clusters cluster_colours(const point_matrix_view& colours, const cluster_count_choice& choice,
                                              std::uint64_t seed, thread_count threads = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/colour_clusters.ipp>
#endif
