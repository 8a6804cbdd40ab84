#pragma once
/// Bodies of solve/k_means.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/random.hpp>
#include <gonio/solve/k_means.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace gonio::detail {

/// The number of a point, drawn with probabilities proportional to weights; any one if all weights are zero.
[[nodiscard]] GONIO_INLINE Eigen::Index draw_point(const Eigen::ArrayXf& weights, std::mt19937_64& generator) {
  double all = 0.0;
  for (const float weight : weights) all += double{weight};
  const double number = uniform_number(generator);
  if (!(all > 0.0)) return static_cast<Eigen::Index>(number * static_cast<double>(weights.size()));
  double left = number * all;
  Eigen::Index last = 0;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (!(weights[i] > 0.0f)) continue;
    last = i;
    left -= double{weights[i]};
    if (left < 0.0) break;
  }
  return last;
}

/// k-means++.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXf draw_centres(const float_matrix_view& points, Eigen::Index count,
                                                        std::mt19937_64& generator, thread_count threads) {
  Eigen::MatrixXf centres(points.rows(), count);
  Eigen::ArrayXf distances = Eigen::ArrayXf::Zero(points.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    centres.col(k) = points.col(draw_point(distances, generator));
    const auto own = find_nearest(centres.col(k), points, threads).squared_distances;
    distances = k == 0 ? own : Eigen::ArrayXf(distances.min(own));
  }
  return centres;
}

/// The means of the points of each cluster. One without points takes the point that is farthest from its centre.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXf means_of(const float_matrix_view& points, nearest_centres& nearest,
                                                    Eigen::Index clusters) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(points.rows(), clusters);
  Eigen::ArrayXd counts = Eigen::ArrayXd::Zero(clusters);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    sums.col(nearest.centres[i]) += points.col(i).cast<double>();
    counts[nearest.centres[i]] += 1.0;
  }
  for (Eigen::Index k = 0; k < clusters; ++k) {
    if (counts[k] > 0.0) {
      sums.col(k) /= counts[k];
    } else {
      Eigen::Index farthest = 0;
      nearest.squared_distances.maxCoeff(&farthest);
      nearest.squared_distances[farthest] = 0.0f;
      sums.col(k) = points.col(farthest).cast<double>();
    }
  }
  return sums.cast<float>();
}

/// Lloyd's iteration from some centres.
[[nodiscard]] GONIO_INLINE point_clusters improve_centres(const float_matrix_view& points, Eigen::MatrixXf centres,
                                                          int rounds, thread_count threads) {
  nearest_centres nearest = find_nearest(centres, points, threads);
  for (int round = 0; round < rounds; ++round) {
    centres = means_of(points, nearest, centres.cols());
    nearest_centres next = find_nearest(centres, points, threads);
    const bool same = (next.centres == nearest.centres).all();
    nearest = std::move(next);
    if (same) break;
  }
  std::vector<Eigen::Index> counts(static_cast<std::size_t>(centres.cols())), order(counts.size());
  for (const int centre : nearest.centres) ++counts[static_cast<std::size_t>(centre)];
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::sort(order, {}, [&](Eigen::Index k) { return std::pair(-counts[static_cast<std::size_t>(k)], k); });
  point_clusters found{Eigen::MatrixXf(centres.rows(), centres.cols()), 0.0};
  for (Eigen::Index k = 0; k < centres.cols(); ++k) found.centres.col(k) = centres.col(order[static_cast<std::size_t>(k)]);
  for (const float distance : nearest.squared_distances) found.mean_squared_distance += double{distance};
  found.mean_squared_distance /= static_cast<double>(points.cols());
  return found;
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE nearest_centres find_nearest(const Eigen::MatrixXf& centres, const float_matrix_view& points,
                                          thread_count threads) {
  nearest_centres found{Eigen::ArrayXi(points.cols()), Eigen::ArrayXf(points.cols())};
  const Eigen::ArrayXf halves = 0.5f * centres.colwise().squaredNorm().transpose().array();
  for_each_block(
      points.cols(), Eigen::Index{512},
      [&](block range) {
        const auto own = points.middleCols(range.begin, range.size());
        const Eigen::MatrixXf products = product(centres.transpose(), own);
        for (Eigen::Index i = 0; i < range.size(); ++i) {
          Eigen::Index nearest = 0;
          (halves - products.col(i).array()).minCoeff(&nearest);
          found.centres[range.begin + i] = static_cast<int>(nearest);
          // Of the difference: a difference of squares would lose what is near.
          found.squared_distances[range.begin + i] = (own.col(i) - centres.col(nearest)).squaredNorm();
        }
      },
      threads);
  return found;
}

GONIO_INLINE point_clusters k_means(const float_matrix_view& points, const k_means_options& options,
                                    thread_count threads) {
  if (options.clusters < 1 || options.starts < 1 || options.rounds < 1)
    refuse({"k-means of ", options.clusters, " clusters, ", options.starts, " starts and ", options.rounds,
            " rounds: expected at least one of each"});
  if (points.cols() < options.clusters)
    refuse({options.clusters, " clusters need as many points, and there are ", points.cols()});
  if (!points.allFinite()) refuse("k-means needs points whose numbers are finite");
  std::mt19937_64 generator(options.seed);
  point_clusters best;
  for (int start = 0; start < options.starts; ++start) {
    point_clusters found = detail::improve_centres(
        points, detail::draw_centres(points, options.clusters, generator, threads), options.rounds, threads);
    if (start == 0 || found.mean_squared_distance < best.mean_squared_distance) best = std::move(found);
  }
  return best;
}

}  // namespace gonio
