#pragma once
/// Clusters of points around their means: Lloyd's algorithm from the seeds of k-means++ (Arthur and Vassilvitskii,
/// "k-means++: The Advantages of Careful Seeding", SODA 2007), and how well they stand apart (Rousseeuw, "Silhouettes:
/// a Graphical Aid to the Interpretation and Validation of Cluster Analysis", 1987, doi:10.1016/0377-0427(87)90125-7).

#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace gonio::capture {

/// Points, one a row: n x d.
using point_matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using point_matrix_view = Eigen::Ref<const point_matrix>;

/// Points in k clusters, none of which is empty, the largest first; of as large ones that whose centre comes first in
/// the order of its coordinates.
struct point_clusters {
  Eigen::VectorXi labels;           ///< n numbers from 0 to k - 1: that of the nearest centre
  point_matrix centres;             ///< k x d, the means of the clusters
  std::vector<Eigen::Index> sizes;  ///< how many points each cluster has
  double inertia = 0.0;             ///< sum of the squared distances of the points to their centres
};

namespace detail {

/// How many of the points differ, but no more than `limit`. O(n limit).
[[nodiscard]] Eigen::Index different_points(const point_matrix_view& points, Eigen::Index limit);

/// The means of clusters none of which is empty: k x d.
[[nodiscard]] point_matrix cluster_means(const point_matrix_view& points, const Eigen::VectorXi& labels, Eigen::Index k,
                                         thread_count threads);

}  // namespace detail

/// Lloyd's algorithm from given centres, k x d: every point goes to the nearest centre, every centre to the mean of its
/// points, until no point changes or for `most_steps` steps. A cluster that loses all its points takes the one farthest
/// from its centre. Throws gonio::error if a number is not finite, dimensions differ, or there are fewer points than
/// centres. O(n k d) a step, same bytes for any number of threads.
[[nodiscard]] point_clusters refine_clusters(const point_matrix_view& points, point_matrix centres,
                                             thread_count threads = {}, int most_steps = 100);

/// The best of ten runs of Lloyd's algorithm from the seeds of k-means++, by inertia. Throws gonio::error if a point is
/// not finite, or unless there are k different points and k is at least 1. The seed alone decides, not the number of
/// threads. O(n k d) a step.
///
/// ```cpp
/// const auto clusters = gonio::capture::k_means(points, 3, seed);
/// ```
[[nodiscard]] point_clusters k_means(const point_matrix_view& points, Eigen::Index k, std::uint64_t seed,
                                     thread_count threads = {});

/// Of points the nearest of some centres, the first of equally near ones.
struct nearest_centres {
  Eigen::VectorXi labels;
  Eigen::VectorXd squared_distances;
};
/// Where points belong that clusters were not made from. Points and centres, k x d, have equally many numbers,
/// otherwise gonio::error is thrown. O(n k d), same bytes for any number of threads.
[[nodiscard]] nearest_centres find_nearest(const point_matrix_view& points, const point_matrix& centres,
                                           thread_count threads = {});

/// How well clusters stand apart, from -1 to 1: the mean over the points of (b - a) / max(a, b), where a is a point's
/// mean distance to the others of its cluster and b that to the points of the nearest other cluster. A point alone in
/// its cluster counts 0 (Rousseeuw 1987), and so does every point if there is one cluster only. `labels` has a number
/// from 0 on for each point, otherwise gonio::error is thrown. O(n^2 d): meant for thousands of points.
[[nodiscard]] double mean_silhouette(const point_matrix_view& points, const Eigen::VectorXi& labels,
                                     thread_count threads = {});

}  // namespace gonio::capture

#if !defined(GONIO_COMPILED)
#include <gonio/capture/impl/k_means.ipp>
#endif
