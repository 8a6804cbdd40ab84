#pragma once
/// Which texels of a map are of one material.

#include <gonio/basis/pca.hpp>
#include <gonio/capture/k_means.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace cli {

/// Clusters of the texels of a map by k-means where distances are those of `gonio::texel_metric`. The centres are found
/// from 16,384 texels, one at random of each of as many equal stretches of the map, so that memory does not grow with
/// it; then each band is assigned to them.
class texel_clusters {
 public:
  /// Throws gonio::error if the map is of another prior, or has not so many texels that differ. Same result for any
  /// number of threads.
  texel_clusters(const gonio::io::svbrdf_map& map, const gonio::log_relative_pca& prior, Eigen::Index clusters,
                 std::uint64_t seed, gonio::thread_count threads);

  [[nodiscard]] Eigen::Index count() const noexcept { return centres_.rows(); }

  /// Of each texel of a band the number of its cluster from 1 on, the largest of the texels that were looked at first;
  /// 0 if it is not of the sample. Adds them to what `summary` says.
  [[nodiscard]] std::vector<std::uint8_t> assign(const gonio::io::svbrdf_band& band);

  /// What was assigned until now.
  struct cluster {
    double texels = 0.0;
    double squared_distances = 0.0;  ///< summed, to the centre
    Eigen::VectorXd weights;         ///< of the map's functions, 3 r: summed
    /// Root mean square of the distances to the centre.
    [[nodiscard]] double distance() const;
  };
  [[nodiscard]] const std::vector<cluster>& summary() const noexcept { return summary_; }
  /// The mean weights of the prior's components of a cluster, k x 3: a mean of logarithms of reflectance.
  [[nodiscard]] Eigen::MatrixXd mean_weights(Eigen::Index number) const;

 private:
  const gonio::io::svbrdf_map& map_;
  gonio::thread_count threads_;
  Eigen::MatrixXf metric_;
  gonio::capture::point_matrix centres_;
  std::vector<cluster> summary_;
};

}  // namespace cli
