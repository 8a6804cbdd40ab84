#pragma once
/// Groups the texels of a map by material.

#include <gonio/basis/pca.hpp>
#include <gonio/capture/k_means.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace cli {

/// Clusters the texels of a map by k-means with the distance of `gonio::texel_metric`. The centres are computed from a
/// sample of 16,384 texels: the map is divided into that many equal ranges, and one texel is drawn at random from each.
/// So memory does not grow with the map. Then the texels of each band are assigned to the centres.
class texel_clusters {
 public:
  /// Throws gonio::error if the map has another prior, or fewer distinct texels than `clusters`. The result does not
  /// depend on the number of threads.
  texel_clusters(const gonio::io::svbrdf_map& map, const gonio::log_relative_pca& prior, Eigen::Index clusters,
                 std::uint64_t seed, gonio::thread_count threads);

  [[nodiscard]] Eigen::Index count() const noexcept { return centres_.rows(); }

  /// Returns for each texel of a band the number of its cluster; 0 for texels that are not part of the flat sample.
  /// Cluster 1 has the most of the texels that the constructor drew, and so on. Adds the texels to `summary`.
  [[nodiscard]] std::vector<std::uint8_t> assign(const gonio::io::svbrdf_band& band);

  /// Sums over the texels that were assigned to one cluster so far.
  struct cluster {
    double texels = 0.0;
    double squared_distances = 0.0;  ///< summed squared distances to the centre
    Eigen::VectorXd weights;         ///< summed weights: 3 channels x the map's functions
    /// Returns the root mean square of the distances to the centre.
    [[nodiscard]] double distance() const;
  };
  [[nodiscard]] const std::vector<cluster>& summary() const noexcept { return summary_; }
  /// Returns the mean weights of the prior's components in a cluster, components x 3: an average of logarithms of
  /// reflectance.
  [[nodiscard]] Eigen::MatrixXd mean_weights(Eigen::Index number) const;

 private:
  const gonio::io::svbrdf_map& map_;
  gonio::thread_count threads_;
  Eigen::MatrixXf metric_;
  gonio::capture::point_matrix centres_;
  std::vector<cluster> summary_;
};

}  // namespace cli
