#include <gonio/capture/k_means.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::capture::k_means;
using gonio::capture::mean_silhouette;
using gonio::capture::point_matrix;

namespace {

/// Returns points with normal noise of this width around each centre, in the order of the centres.
point_matrix blobs(const point_matrix& centres, Eigen::Index each, double width, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  point_matrix points(centres.rows() * each, centres.cols());
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (Eigen::Index j = 0; j < points.cols(); ++j)
      points(i, j) = centres(i % centres.rows(), j) + width * normal(generator);
  return points;
}

}  // namespace

TEST_CASE("k-means: numbers on a line, by hand") {
  const point_matrix points = Eigen::VectorXd{{0, 1, 10, 11, 12, 30}};
  const auto found = k_means(points, 3, 1);
  CHECK(found.labels == Eigen::VectorXi{{1, 1, 0, 0, 0, 2}});
  CHECK(found.centres == point_matrix(Eigen::VectorXd{{11, 0.5, 30}}));
  CHECK(found.sizes == std::vector<Eigen::Index>{3, 2, 1});
  CHECK(found.inertia == doctest::Approx(2.5));
}

TEST_CASE("k-means: clusters far apart are found from any seed, the largest first") {
  const point_matrix centres{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {9, 9, 9}};
  auto points = blobs(centres, 50, 0.3, 3);
  points.conservativeResize(260, 3);  // sixty more points around the last centre
  points.bottomRows(60) = blobs(centres.bottomRows(1), 60, 0.3, 4);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto found = k_means(points, 4, seed);
    CHECK(found.sizes == std::vector<Eigen::Index>{110, 50, 50, 50});
    // The three clusters of equal size are ordered by their centres.
    const point_matrix expected{{9, 9, 9}, {0, 9, 0}, {0, 0, 0}, {9, 0, 0}};
    CHECK((found.centres - expected).row(0).norm() < 0.2);
    for (Eigen::Index c = 1; c < 4; ++c)
      CHECK((expected.bottomRows(3).rowwise() - found.centres.row(c)).rowwise().norm().minCoeff() < 0.2);
    for (Eigen::Index c = 2; c < 4; ++c) CHECK(found.centres(c - 1, 0) <= found.centres(c, 0));
  }
}

TEST_CASE("k-means: property: every centre is the mean of its points, and every point is nearest to its own centre") {
  CHECK(rc::check("at rest", [] {
    const auto n = *rc::gen::inRange<Eigen::Index>(5, 80), d = *rc::gen::inRange<Eigen::Index>(1, 4);
    const auto k = *rc::gen::inRange<Eigen::Index>(1, 6);
    const auto seed = *rc::gen::inRange(0u, 1000u);
    const point_matrix points = blobs(point_matrix::Zero(1, d), n, 1.0, seed);
    const auto found = k_means(points, k, seed);
    RC_ASSERT(found.centres.rows() == k);
    RC_ASSERT(std::ranges::is_sorted(found.sizes, std::greater{}));
    double inertia = 0.0;
    point_matrix sums = point_matrix::Zero(k, d);
    std::vector<Eigen::Index> sizes(k);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::VectorXd squares = (found.centres.rowwise() - points.row(i)).rowwise().squaredNorm();
      RC_ASSERT(squares[found.labels[i]] <= squares.minCoeff() + 1e-12);
      inertia += squares[found.labels[i]];
      sums.row(found.labels[i]) += points.row(i);
      ++sizes[found.labels[i]];
    }
    RC_ASSERT(sizes == found.sizes);
    RC_ASSERT(std::abs(inertia - found.inertia) < 1e-9 * (1.0 + inertia));
    for (Eigen::Index c = 0; c < k; ++c) {
      const auto size = static_cast<double>(found.sizes[c]);
      RC_ASSERT((found.centres.row(c) - sums.row(c) / size).norm() < 1e-9);
    }
  }));
}

TEST_CASE("k-means: the same bytes for any number of threads") {
  const auto points = blobs(point_matrix{{0, 0}, {2, 1}, {0, 3}}, 5000, 1.0, 8);
  const auto one = k_means(points, 4, 5, {1}), three = k_means(points, 4, 5, {3});
  CHECK(one.labels == three.labels);
  CHECK(one.centres == three.centres);
  CHECK(one.inertia == three.inertia);
  const point_matrix some = points.topRows(300);
  CHECK(mean_silhouette(some, one.labels.head(300), {1}) == mean_silhouette(some, one.labels.head(300), {3}));
}

TEST_CASE("k-means: a cluster that loses its points takes the farthest one") {
  const point_matrix points = Eigen::VectorXd{{0, 1, 2, 50}};
  const auto found = gonio::capture::refine_clusters(points, Eigen::VectorXd{{1, 1000}});
  CHECK(found.sizes == std::vector<Eigen::Index>{3, 1});
  CHECK(found.centres == point_matrix(Eigen::VectorXd{{1, 50}}));
  const auto several = gonio::capture::refine_clusters(points, Eigen::VectorXd{{1, 1000, 2000, 3000}});
  CHECK(several.sizes == std::vector<Eigen::Index>{1, 1, 1, 1});
  CHECK(several.inertia == 0.0);
}

TEST_CASE("k-means: coincident points make as many clusters as there are distinct points") {
  point_matrix points(40, 2);
  for (Eigen::Index i = 0; i < 40; ++i) points.row(i) << static_cast<double>(i % 4 == 0), 2.0;
  const auto found = k_means(points, 2, 0);
  CHECK(found.sizes == std::vector<Eigen::Index>{30, 10});
  CHECK(found.inertia == 0.0);
  CHECK_THROWS_WITH_AS((void)k_means(points, 3, 0), doctest::Contains("only 2 of 40 points differ"), gonio::error);
}

TEST_CASE("silhouettes: by hand, alone and in one cluster") {
  const point_matrix points = Eigen::VectorXd{{0, 1, 4, 6}};
  // a: 1, 1, 2, 2; b: 5, 4, 3.5, 5.5
  const double expected = (4.0 / 5 + 3.0 / 4 + 1.5 / 3.5 + 3.5 / 5.5) / 4;
  CHECK(mean_silhouette(points, Eigen::VectorXi{{0, 0, 1, 1}}) == doctest::Approx(expected));
  CHECK(mean_silhouette(points, Eigen::VectorXi{{0, 0, 5, 5}}) == doctest::Approx(expected));
  CHECK(mean_silhouette(points, Eigen::VectorXi{{0, 0, 0, 0}}) == 0.0);
  CHECK(mean_silhouette(points, Eigen::VectorXi{{0, 1, 2, 3}}) == 0.0);
  CHECK(mean_silhouette(points, Eigen::VectorXi{{0, 1, 0, 1}}) < 0.0);
  CHECK(mean_silhouette(point_matrix::Zero(4, 1), Eigen::VectorXi{{0, 0, 1, 1}}) == 0.0);
}

TEST_CASE("k-means: bad input") {
  point_matrix points = Eigen::VectorXd{{0, 1, 4, 6}};
  CHECK_THROWS_WITH_AS((void)k_means(points, 0, 0), doctest::Contains("at least one"), gonio::error);
  CHECK_THROWS_WITH_AS((void)k_means(points, 5, 0), doctest::Contains("only 4 of 4"), gonio::error);
  CHECK_THROWS_AS((void)k_means(point_matrix(0, 3), 1, 0), gonio::error);
  CHECK_THROWS_WITH_AS((void)gonio::capture::refine_clusters(points, point_matrix::Zero(2, 3)),
                       doctest::Contains("centres of 3"), gonio::error);
  CHECK_THROWS_AS((void)gonio::capture::refine_clusters(points, point_matrix(0, 1)), gonio::error);
  CHECK_THROWS_AS((void)mean_silhouette(points, Eigen::VectorXi{{0, 1, 0}}), gonio::error);
  CHECK_THROWS_AS((void)mean_silhouette(points, Eigen::VectorXi{{0, 1, 0, -1}}), gonio::error);
  points(2, 0) = std::nan("");
  CHECK_THROWS_WITH_AS((void)k_means(points, 2, 0), doctest::Contains("point 3 is not finite"), gonio::error);
}

TEST_CASE("k-means: new points go to the nearest centre, the first of equally near ones") {
  const point_matrix centres = Eigen::VectorXd{{1000, 1002, 1002, 5}};
  const point_matrix points = Eigen::VectorXd{{1001.75, 1000.25, -3, 1001}};
  const auto found = gonio::capture::find_nearest(points, centres);
  CHECK(found.labels == Eigen::VectorXi{{1, 0, 3, 0}});
  CHECK(found.squared_distances == Eigen::VectorXd{{0.0625, 0.0625, 64, 1}});
  const point_matrix middles{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const point_matrix cloud = blobs(middles, 4000, 0.7, 3);
  const auto clusters = k_means(cloud.topRows(500), 5, 2);
  const auto one = gonio::capture::find_nearest(cloud, clusters.centres, {1});
  CHECK(one.labels == gonio::capture::find_nearest(cloud, clusters.centres, {4}).labels);
  CHECK(one.labels.head(500) == clusters.labels);
  CHECK_THROWS_WITH_AS((void)gonio::capture::find_nearest(points, clusters.centres), doctest::Contains("1 numbers"),
                       gonio::error);
}
