#pragma once
/// Bodies of capture/k_means.hpp.

#include <gonio/capture/k_means.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace gonio::capture::detail {

GONIO_INLINE void require_finite_points(const point_matrix_view& points) {
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (!points.row(i).allFinite()) refuse("point " + std::to_string(i + 1) + " is not finite");
}

GONIO_INLINE Eigen::Index different_points(const point_matrix_view& points, Eigen::Index limit) {
  point_matrix found(limit, points.cols());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < points.rows() && count < limit; ++i) {
    Eigen::Index j = 0;
    while (j < count && found.row(j) != points.row(i)) ++j;
    if (j == count) found.row(count++) = points.row(i);
  }
  return count;
}

/// Returns seeds for k-means. The first centre is a random point. Each further centre is chosen with a probability
/// proportional to its squared distance from the nearest of the centres already chosen. There must be at least k
/// distinct points.
[[nodiscard]] GONIO_INLINE point_matrix seed_centres(const point_matrix_view& points, Eigen::Index k,
                                                     std::mt19937_64& generator) {
  point_matrix centres(k, points.cols());
  centres.row(0) = points.row(std::uniform_int_distribution<Eigen::Index>(0, points.rows() - 1)(generator));
  Eigen::VectorXd squares = (points.rowwise() - centres.row(0)).rowwise().squaredNorm();
  for (Eigen::Index c = 1; c < k; ++c) {
    double rest = std::uniform_real_distribution<double>(0.0, squares.sum())(generator);
    Eigen::Index chosen = 0;
    // Use the farthest point if rounding leaves a remainder of the sum after all points.
    squares.maxCoeff(&chosen);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      rest -= squares[i];
      if (!(rest < 0.0)) continue;
      chosen = i;
      break;
    }
    centres.row(c) = points.row(chosen);
    squares = squares.cwiseMin((points.rowwise() - centres.row(c)).rowwise().squaredNorm());
  }
  return centres;
}

/// Assigns each point to the nearest centre (the first if several are equally near), and writes the squared distances.
/// Returns true if a label changed. O(n k d).
[[nodiscard]] GONIO_INLINE bool assign(const point_matrix_view& points, const point_matrix& centres,
                                       Eigen::VectorXi& labels, Eigen::VectorXd& squares, thread_count threads) {
  const Eigen::VectorXi before = labels;
  for_each_block(
      points.rows(), 4096,
      [&](block range) {
        for (Eigen::Index i = range.begin; i < range.end; ++i) {
          squares[i] = std::numeric_limits<double>::infinity();
          for (Eigen::Index c = 0; c < centres.rows(); ++c) {
            const double square = (points.row(i) - centres.row(c)).squaredNorm();
            if (!(square < squares[i])) continue;
            squares[i] = square;
            labels[i] = static_cast<int>(c);
          }
        }
      },
      threads);
  return labels != before;
}

/// Returns the number of points of each cluster.
[[nodiscard]] GONIO_INLINE std::vector<Eigen::Index> cluster_sizes(const Eigen::VectorXi& labels, Eigen::Index k) {
  std::vector<Eigen::Index> sizes(k);
  for (const int label : labels) ++sizes[label];
  return sizes;
}

/// Gives each empty cluster the point that is farthest from the centre of its own cluster, among clusters of at least
/// two points.
GONIO_INLINE void refill_empty_clusters(Eigen::VectorXi& labels, Eigen::VectorXd& squares, Eigen::Index k) {
  std::vector<Eigen::Index> sizes = cluster_sizes(labels, k);
  for (Eigen::Index c = 0; c < std::ssize(sizes); ++c) {
    if (sizes[c] > 0) continue;
    Eigen::Index farthest = -1;
    for (Eigen::Index i = 0; i < labels.size(); ++i)
      if (sizes[labels[i]] > 1 && (farthest < 0 || squares[i] > squares[farthest])) farthest = i;
    --sizes[labels[farthest]];
    ++sizes[c];
    labels[farthest] = static_cast<int>(c);
    squares[farthest] = 0.0;
  }
}

GONIO_INLINE point_matrix cluster_means(const point_matrix_view& points, const Eigen::VectorXi& labels, Eigen::Index k,
                                        thread_count threads) {
  const point_matrix zero =
      point_matrix::Zero(k, points.cols() + 1);  // sums, and the number of points in the last column
  const point_matrix sums = sum_over_blocks(
      points.rows(), 4096, zero,
      [&](point_matrix& sum, block range) {
        for (Eigen::Index i = range.begin; i < range.end; ++i) {
          sum.row(labels[i]).head(points.cols()) += points.row(i);
          sum(labels[i], points.cols()) += 1.0;
        }
      },
      threads);
  return sums.leftCols(points.cols()).array().colwise() / sums.col(points.cols()).array();
}

/// Renumbers the clusters by size.
[[nodiscard]] GONIO_INLINE point_clusters ordered_by_size(const Eigen::VectorXi& labels, const point_matrix& centres,
                                                          double inertia) {
  const std::vector<Eigen::Index> sizes = cluster_sizes(labels, centres.rows());
  std::vector<Eigen::Index> order(sizes.size()), rank(sizes.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const auto centre = [&](Eigen::Index c) { return centres.row(c); };
  std::ranges::sort(order, [&](Eigen::Index a, Eigen::Index b) {
    if (sizes[a] != sizes[b]) return sizes[a] > sizes[b];
    return std::ranges::lexicographical_compare(centre(a), centre(b));
  });
  point_clusters ordered{labels, point_matrix(centres.rows(), centres.cols()), {}, inertia};
  for (Eigen::Index r = 0; r < std::ssize(order); ++r) {
    rank[order[r]] = r;
    ordered.centres.row(r) = centre(order[r]);
    ordered.sizes.push_back(sizes[order[r]]);
  }
  for (int& label : ordered.labels) label = static_cast<int>(rank[label]);
  return ordered;
}

}  // namespace gonio::capture::detail

namespace gonio::capture {

GONIO_INLINE point_clusters refine_clusters(const point_matrix_view& points, point_matrix centres, thread_count threads,
                                            int most_steps) {
  const Eigen::Index n = points.rows(), k = centres.rows();
  if (k < 1 || n < k || points.cols() != centres.cols())
    refuse(std::to_string(n) + " points of " + std::to_string(points.cols()) + " numbers cannot be clustered around " +
           std::to_string(k) + " centres of " + std::to_string(centres.cols()));
  detail::require_finite_points(points);
  detail::require_finite_points(centres);
  Eigen::VectorXi labels = Eigen::VectorXi::Constant(n, -1);
  Eigen::VectorXd squares(n);
  for (int step = 0; step < most_steps; ++step) {
    if (!detail::assign(points, centres, labels, squares, threads)) break;
    detail::refill_empty_clusters(labels, squares, k);
    centres = detail::cluster_means(points, labels, k, threads);
  }
  // `squares` still has the squared distances from the centres before the last update: compute them again.
  for (Eigen::Index i = 0; i < n; ++i) squares[i] = (points.row(i) - centres.row(labels[i])).squaredNorm();
  return detail::ordered_by_size(labels, centres, squares.sum());
}

GONIO_INLINE point_clusters k_means(const point_matrix_view& points, Eigen::Index k, std::uint64_t seed,
                                    thread_count threads) {
  constexpr int restarts = 10;
  if (k < 1) refuse("k-means needs at least one cluster, not " + std::to_string(k));
  detail::require_finite_points(points);
  if (const Eigen::Index different = detail::different_points(points, k); different < k)
    refuse("only " + std::to_string(different) + " of " + std::to_string(points.rows()) +
           " points differ: they cannot make " + std::to_string(k) + " clusters");
  std::mt19937_64 generator(seed);
  point_clusters best;
  best.inertia = std::numeric_limits<double>::infinity();
  for (int run = 0; run < restarts; ++run) {
    point_clusters found = refine_clusters(points, detail::seed_centres(points, k, generator), threads);
    if (found.inertia < best.inertia) best = std::move(found);
  }
  return best;
}

GONIO_INLINE nearest_centres find_nearest(const point_matrix_view& points, const point_matrix& centres,
                                          thread_count threads) {
  if (centres.rows() < 1 || points.cols() != centres.cols())
    refuse({"points of ", points.cols(), " numbers cannot be compared with ", centres.rows(), " centres of ",
            centres.cols()});
  nearest_centres found{Eigen::VectorXi::Zero(points.rows()), Eigen::VectorXd(points.rows())};
  static_cast<void>(detail::assign(points, centres, found.labels, found.squared_distances, threads));
  return found;
}

GONIO_INLINE double mean_silhouette(const point_matrix_view& points, const Eigen::VectorXi& labels,
                                    thread_count threads) {
  if (labels.size() != points.rows() || points.rows() == 0 || labels.minCoeff() < 0)
    refuse("a silhouette needs at least one point, and for each a label of at least 0");
  const std::vector<Eigen::Index> sizes = detail::cluster_sizes(labels, labels.maxCoeff() + 1);
  const auto own_size = [&](Eigen::Index i) { return sizes[labels[i]]; };
  const auto width_of = [&](Eigen::Index i) {
    if (own_size(i) < 2) return 0.0;
    std::vector<double> distances(sizes.size());
    for (Eigen::Index j = 0; j < points.rows(); ++j) distances[labels[j]] += (points.row(i) - points.row(j)).norm();
    const Eigen::Index own = labels[i];
    const double a = distances[own] / static_cast<double>(sizes[own] - 1);
    double b = std::numeric_limits<double>::infinity();
    for (Eigen::Index c = 0; c < std::ssize(sizes); ++c)
      if (c != own && sizes[c] > 0) b = std::min(b, distances[c] / static_cast<double>(sizes[c]));
    const double larger = std::max(a, b);
    return std::isfinite(b) && larger > 0.0 ? (b - a) / larger : 0.0;
  };
  const Eigen::Index n = points.rows();
  const double sum = sum_over_blocks(
      n, 64, 0.0,
      [&](double& total, block range) {
        for (Eigen::Index i = range.begin; i < range.end; ++i) total += width_of(i);
      },
      threads);
  return sum / static_cast<double>(n);
}

}  // namespace gonio::capture
