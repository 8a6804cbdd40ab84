#include <gonio/core/error.hpp>
#include <gonio/core/random.hpp>
#include <gonio/solve/k_means.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <random>

using gonio::find_nearest;
using gonio::k_means;

namespace {

/// Points of three clouds around (0, 0), (10, 0) and (0, 20): 600, 300 and 100, in this order.
Eigen::MatrixXf clouds() {
  std::mt19937_64 generator(4);
  std::normal_distribution<float> deviation;
  Eigen::MatrixXf points(2, 1000);
  for (Eigen::Index i = 0; i < 1000; ++i) {
    const float right = i >= 600 && i < 900 ? 10.0f : 0.0f, up = i >= 900 ? 20.0f : 0.0f;
    points.col(i) << right + deviation(generator), up + deviation(generator);
  }
  return points;
}

}  // namespace

TEST_CASE("k-means: finds clouds, those of most points first, and its mean of squares") {
  const Eigen::MatrixXf points = clouds();
  const auto found = k_means(points, {.clusters = 3});
  const auto nearest = find_nearest(found.centres, points);
  CHECK((nearest.centres.head(600) == 0).all());
  CHECK((nearest.centres.segment(600, 300) == 1).all());
  CHECK((nearest.centres.tail(100) == 2).all());
  CHECK((found.centres.col(0) - points.leftCols(600).rowwise().mean()).norm() < 1e-5f);
  CHECK((found.centres.col(2) - points.rightCols(100).rowwise().mean()).norm() < 1e-4f);
  CHECK(found.mean_squared_distance == doctest::Approx(nearest.squared_distances.mean()).epsilon(1e-5));
  CHECK(found.mean_squared_distance == doctest::Approx(2.0).epsilon(0.1));
}

TEST_CASE("k-means: one cluster is the mean; as many as points are the points") {
  const Eigen::MatrixXf points = clouds();
  const auto one = k_means(points, {.clusters = 1});
  CHECK((one.centres - points.rowwise().mean()).norm() < 1e-4f);
  const Eigen::MatrixXf few = points.middleCols(595, 12);
  const auto all = k_means(few, {.clusters = 12, .starts = 1});
  CHECK(all.mean_squared_distance < 1e-12);
  // A cluster that lost its points takes one that is far: points that are the same do not hide the others.
  Eigen::MatrixXf same = Eigen::MatrixXf::Zero(2, 50);
  same(0, 49) = 1.0f;
  CHECK(k_means(same, {.clusters = 2, .starts = 1}).mean_squared_distance == 0.0);
  CHECK(k_means(Eigen::MatrixXf::Ones(2, 50), {.clusters = 3}).mean_squared_distance == 0.0);
}

TEST_CASE("k-means: the same bytes for any number of threads, other draws for other seeds") {
  const Eigen::MatrixXf points = Eigen::MatrixXf::Random(5, 3000);
  const auto one = k_means(points, {.clusters = 7, .seed = 3}, {1});
  const auto four = k_means(points, {.clusters = 7, .seed = 3}, {4});
  CHECK(one.centres == four.centres);
  CHECK(one.mean_squared_distance == four.mean_squared_distance);
  CHECK(k_means(points, {.clusters = 7, .seed = 4}).centres != one.centres);
}

TEST_CASE("k-means: more starts are never worse") {
  const Eigen::MatrixXf points = Eigen::MatrixXf::Random(3, 500);
  double before = std::numeric_limits<double>::infinity();
  for (const int starts : {1, 2, 4, 8}) {
    const double now = k_means(points, {.clusters = 9, .starts = starts}).mean_squared_distance;
    CHECK(now <= before);
    before = now;
  }
}

TEST_CASE("k-means: distances far from the origin, and of equally near centres the first") {
  Eigen::MatrixXf centres(1, 3), points(1, 2);
  centres << 1000.0f, 1002.0f, 1002.0f;
  points << 1001.75f, 1000.25f;
  const auto found = find_nearest(centres, points);
  CHECK(found.centres[0] == 1);
  CHECK(found.centres[1] == 0);
  CHECK(found.squared_distances[0] == 0.0625f);
}

TEST_CASE("k-means: bad input is refused") {
  Eigen::MatrixXf points = clouds();
  CHECK_THROWS_WITH_AS((void)k_means(points.leftCols(2), {.clusters = 3}), doctest::Contains("3 clusters"),
                       gonio::error);
  CHECK_THROWS_WITH_AS((void)k_means(points, {.clusters = 0}), doctest::Contains("0 clusters"), gonio::error);
  CHECK_THROWS_WITH_AS((void)k_means(points, {.clusters = 2, .starts = 0}), doctest::Contains("0 starts"),
                       gonio::error);
  points(1, 7) = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH_AS((void)k_means(points, {}), doctest::Contains("finite"), gonio::error);
}
