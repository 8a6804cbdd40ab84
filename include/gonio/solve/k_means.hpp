#pragma once
/// k-means: k centres such that the sum of squared distances of points to the nearest is small. Lloyd's iteration
/// (1982, doi:10.1109/TIT.1982.1056489) from starts by k-means++ (Arthur and Vassilvitskii 2007, SODA), each centre a
/// point drawn with a probability that is proportional to its squared distance from those before.

#include <gonio/core/parallel.hpp>
#include <gonio/solve/float_product.hpp>

#include <Eigen/Core>

#include <cstdint>

namespace gonio {

struct k_means_options {
  Eigen::Index clusters = 2;
  std::uint64_t seed = 1;
  int starts = 8;    ///< of which the one with the least sum of squares counts
  int rounds = 100;  ///< at most, of each start; it ends before where no point changes its cluster
};

struct point_clusters {
  Eigen::MatrixXf centres;  ///< dimensions x clusters: those of most points first
  double mean_squared_distance = 0.0;
};

/// The nearest of some centres to each point; of equally near ones the first.
struct nearest_centres {
  Eigen::ArrayXi centres;
  Eigen::ArrayXf squared_distances;
};
/// Points are columns. Same bytes for any number of threads. O(points x clusters x dimensions).
[[nodiscard]] nearest_centres find_nearest(const Eigen::MatrixXf& centres, const float_matrix_view& points,
                                           thread_count threads = {});

/// Points are columns. Throws gonio::error if there are fewer than clusters, or a number is not finite. Same bytes for
/// any number of threads. O(starts x rounds x points x clusters x dimensions).
[[nodiscard]] point_clusters k_means(const float_matrix_view& points, const k_means_options& options,
                                     thread_count threads = {});

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/solve/impl/k_means.ipp>
#endif
