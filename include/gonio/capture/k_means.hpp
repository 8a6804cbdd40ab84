#pragma once
/// K-means clustering: Lloyd's algorithm with k-means++ seeds (Arthur and Vassilvitskii, "k-means++: The Advantages of
/// Careful Seeding", SODA 2007), and the separation of clusters (Rousseeuw, "Silhouettes: a Graphical Aid to the
/// Interpretation and Validation of Cluster Analysis", 1987, doi:10.1016/0377-0427(87)90125-7).

#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace gonio::capture {

/// Points, one per row: n x d.
using point_matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using point_matrix_view = Eigen::Ref<const point_matrix>;

/// Points in k non-empty clusters, the largest first. Clusters of equal size are ordered by their centres' coordinates.
struct point_clusters {
  Eigen::VectorXi labels;           ///< the nearest centre of each point, from 0 to k - 1
  point_matrix centres;             ///< k x d, the means of the clusters
  std::vector<Eigen::Index> sizes;  ///< number of points of each cluster
  double inertia = 0.0;             ///< sum of the squared distances of the points to their centres
};

namespace detail {

/// Returns the number of distinct points, at most `limit`. O(n limit).
[[nodiscard]] Eigen::Index different_points(const point_matrix_view& points, Eigen::Index limit);

/// Returns the means of non-empty clusters: k x d.
[[nodiscard]] point_matrix cluster_means(const point_matrix_view& points, const Eigen::VectorXi& labels, Eigen::Index k,
                                         thread_count threads);

}  // namespace detail

/// Lloyd's algorithm from given centres, k x d. Assigns every point to the nearest centre and moves every centre to the
/// mean of its points, until no point changes or for `most_steps` steps. A cluster that loses all its points takes the
/// point farthest from the centre of its own cluster. Throws gonio::error if a number is not finite, if dimensions
/// differ, or if there are fewer points than centres. O(n k d) per step. The bytes do not depend on the number of
/// threads.
[[nodiscard]] point_clusters refine_clusters(const point_matrix_view& points, point_matrix centres,
                                             thread_count threads = {}, int most_steps = 100);

/// Runs Lloyd's algorithm ten times with k-means++ seeds, and returns the clusters with the smallest inertia. Throws
/// gonio::error if a point is not finite, or unless k is at least 1 and there are k distinct points. The result depends
/// on the seed, not on the number of threads. O(n k d) per step.
///
/// ```cpp
/// const auto clusters = gonio::capture::k_means(points, 3, seed);
/// ```
[[nodiscard]] point_clusters k_means(const point_matrix_view& points, Eigen::Index k, std::uint64_t seed,
                                     thread_count threads = {});

/// The nearest centre of each point; the first if several are equally near.
struct nearest_centres {
  Eigen::VectorXi labels;
  Eigen::VectorXd squared_distances;
};
/// Assigns new points to the nearest centres. Throws gonio::error unless points and centres, k x d, have the same
/// dimension. O(n k d). The bytes do not depend on the number of threads.
[[nodiscard]] nearest_centres find_nearest(const point_matrix_view& points, const point_matrix& centres,
                                           thread_count threads = {});

/// Returns the separation of clusters, from -1 to 1: the mean over the points of (b - a) / max(a, b). Here a is a
/// point's mean distance from the other points of its cluster, and b is its mean distance from the points of the
/// nearest other cluster. A point alone in its cluster counts 0 (Rousseeuw 1987), and so does every point of a single
/// cluster. Throws gonio::error unless `labels` has a number of at least 0 for each point. O(n^2 d): meant for
/// thousands of points.
[[nodiscard]] double mean_silhouette(const point_matrix_view& points, const Eigen::VectorXi& labels,
                                     thread_count threads = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/k_means.ipp>
#endif
