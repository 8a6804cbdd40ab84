#include <gonio/capture/colour_clusters.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <array>

using gonio::rgb;
using gonio::capture::cluster_colours;
using gonio::capture::cluster_count_choice;
using gonio::capture::point_matrix;

namespace {

const std::array<rgb, 3> paints{rgb(0.6, 0.6, 0.55), rgb(0.1, 0.4, 0.1), rgb(0.5, 0.1, 0.05)};

/// Returns the paint at a pixel of a synthetic greeting card. The paints cover a half, a third and a sixth of it.
int paint_at(Eigen::Index pixel) {
  constexpr std::array<int, 6> pattern{0, 1, 0, 2, 0, 1};
  return pattern[pixel % 6];
}

/// Returns pixels with the colours `colour(i, normal, uniform)`; the last two arguments are random distributions.
template <class Colour>
point_matrix synthetic_image(Eigen::Index pixels, unsigned seed, Colour&& colour) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  point_matrix colours(pixels, 3);
  for (Eigen::Index i = 0; i < pixels; ++i)
    colours.row(i) = rgb(colour(
                             i, [&] { return normal(generator); }, [&] { return uniform(generator); }))
                         .matrix();
  return colours;
}

/// A greeting card under uneven light, with noise.
point_matrix greeting_card(Eigen::Index pixels, unsigned seed) {
  return synthetic_image(pixels, seed, [](Eigen::Index i, auto&& normal, auto&& uniform) {
    const rgb noise(normal(), normal(), normal());
    return rgb(paints[paint_at(i)] * (0.7 + 0.3 * uniform()) + 0.01 * noise);
  });
}

}  // namespace

TEST_CASE("a card of three paints comes apart, with the number given or chosen, in any unit") {
  const point_matrix colours = greeting_card(9000, 1);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto given = cluster_colours(colours, 3, seed);
    const auto chosen = cluster_colours(1e4 * colours, cluster_count_choice{}, seed);
    CHECK(given.labels == chosen.labels);
    REQUIRE(chosen.count() == 3);
    std::size_t wrong = 0;
    for (Eigen::Index i = 0; i < colours.rows(); ++i)
      if (given.labels[i] != paint_at(i)) ++wrong;
    CHECK(wrong == 0);
    CHECK(given.sizes == std::vector<Eigen::Index>{4500, 3000, 1500});
    CHECK(given.silhouette > 0.8);
    CHECK(given.silhouettes.empty());
    CHECK(chosen.silhouettes.size() == 6);
    CHECK(std::ranges::max_element(chosen.silhouettes) - chosen.silhouettes.begin() == 2);
    for (std::size_t m = 0; m < 3; ++m) {
      const rgb centre = given.centres.row(m).transpose();
      CHECK((centre - 0.85 * paints[m]).abs().maxCoeff() < 0.01);
    }
  }
}

TEST_CASE("the pixels of the clusters are all pixels, each once") {
  const auto found = cluster_colours(greeting_card(1200, 2), 4, 3);
  std::vector<Eigen::Index> all;
  for (Eigen::Index m = 0; m < found.count(); ++m) {
    const auto pixels = found.pixels(m);
    CHECK(pixels.size() == found.sizes[m]);
    CHECK(std::ranges::is_sorted(pixels));
    all.insert(all.end(), pixels.begin(), pixels.end());
  }
  std::ranges::sort(all);
  REQUIRE(all.size() == 1200);
  for (std::size_t i = 0; i < all.size(); ++i) REQUIRE(all[i] == i);
}

TEST_CASE("one material is one cluster, noisy, shaded or both") {
  using pixel = Eigen::Index;
  const auto alone = [](const point_matrix& colours, double least) {
    const auto found = cluster_colours(colours, cluster_count_choice{}, 4);
    CHECK(found.count() == 1);
    CHECK(found.silhouette == 0.0);
    CHECK(found.sizes[0] == 6000);
    const double largest = std::ranges::max(found.silhouettes);
    CHECK(largest > least);
    CHECK(largest < 0.645);
  };
  alone(synthetic_image(
            6000, 5,
            [](pixel, auto&& normal, auto&&) { return rgb(paints[0] + 0.03 * rgb(normal(), normal(), normal())); }),
        0.35);
  alone(
      synthetic_image(6000, 6, [](pixel, auto&& normal, auto&&) { return rgb(paints[2] * std::exp(0.3 * normal())); }),
      0.5);
  alone(
      synthetic_image(6000, 7, [](pixel, auto&&, auto&& uniform) { return rgb(paints[2] * (0.5 + 0.5 * uniform())); }),
      0.6);
  alone(synthetic_image(6000, 8, [](pixel, auto&&, auto&& uniform) { return rgb(paints[0] * std::pow(uniform(), 2)); }),
        0.5);
}

TEST_CASE("two clouds eight deviations apart are two clusters, by their lightness alone") {
  // L* is 116 cbrt(Y) - 16.
  const auto grey = [](double lightness) { return rgb(rgb::Constant(std::pow((lightness + 16.0) / 116.0, 3))); };
  const auto colours = synthetic_image(6000, 9, [&](Eigen::Index i, auto&& normal, auto&&) {
    if (i % 50 == 0) return grey(100.0);  // sets the exposure
    return grey((i % 3 == 0 ? 30.0 : 54.0) + 3.0 * normal());
  });
  const auto found = cluster_colours(colours, cluster_count_choice{.most = 3}, 4);
  CHECK(found.count() == 3);
  CHECK(found.sizes[0] >= 3920);
  CHECK(found.sizes[2] == 120);
  CHECK(cluster_colours(colours, cluster_count_choice{.most = 1}, 4).count() == 1);
}

TEST_CASE("an image of one colour, of one pixel, and of few colours") {
  const point_matrix same = point_matrix::Constant(50, 3, 0.2);
  CHECK(cluster_colours(same, cluster_count_choice{}, 0).count() == 1);
  CHECK(cluster_colours(same.topRows(1), cluster_count_choice{}, 0).labels[0] == 0);
  point_matrix two = point_matrix::Constant(50, 3, 0.2);
  two.topRows(10).col(1).setConstant(0.4);
  const auto found = cluster_colours(two, cluster_count_choice{}, 0);
  CHECK(found.count() == 2);
  CHECK(found.silhouette == doctest::Approx(1.0));
  CHECK(found.labels[0] == 1);
  CHECK_THROWS_WITH_AS((void)cluster_colours(two, 3, 0), doctest::Contains("only 2 of 50"), gonio::error);
}

TEST_CASE("a colour too rare for the sample is found if it is asked for") {
  point_matrix colours = point_matrix::Constant(60000, 3, 0.2);
  colours.row(31234) << 0.5, 0.1, 0.1;
  const auto found = cluster_colours(colours, 2, 0);
  CHECK(found.sizes == std::vector<Eigen::Index>{59999, 1});
  CHECK(found.labels[31234] == 1);
}

TEST_CASE("property: the result depends on the seed, not on the number of threads or the unit") {
  CHECK(rc::check("the same again", [] {
    const auto seed = *rc::gen::inRange(0u, 1000u);
    const point_matrix colours = greeting_card(*rc::gen::inRange<Eigen::Index>(60, 3000), seed);
    const auto one = cluster_colours(colours, cluster_count_choice{.most = 4}, seed, {1});
    const auto three = cluster_colours(colours, cluster_count_choice{.most = 4}, seed, {3});
    RC_ASSERT(one.labels == three.labels);
    RC_ASSERT(one.centres == three.centres);
    RC_ASSERT(one.silhouettes == three.silhouettes);
    RC_ASSERT(one.count() == 3u);
    RC_ASSERT(cluster_colours(0.25 * colours, 3, seed).labels == cluster_colours(colours, 3, seed).labels);
  }));
}

TEST_CASE("coordinates are CIELAB, scaled by the 99th percentile of the brightness") {
  point_matrix colours = point_matrix::Constant(201, 3, 0.5);
  colours.row(7) << 40.0, 40.0, 40.0;
  colours.row(8) << 0.25, 0.5, 0.0;
  colours.row(9) << -0.1, 0.0, 0.0;
  const auto lab = gonio::capture::clustering_coordinates(colours);
  CHECK((lab.row(0) - Eigen::RowVector3d(100, 0, 0)).norm() < 0.02);
  CHECK(lab.row(7) == lab.row(0));
  CHECK((lab.row(8).transpose().array() - gonio::to_lab({0.5, 1.0, 0.0})).abs().maxCoeff() < 1e-12);
  CHECK(lab.row(9).norm() < 1e-12);
}

TEST_CASE("images that have no colours to cluster by are refused") {
  point_matrix colours = point_matrix::Constant(50, 3, 0.2);
  CHECK_THROWS_WITH_AS((void)cluster_colours(colours, 0, 0), doctest::Contains("at least one"), gonio::error);
  CHECK_THROWS_WITH_AS((void)cluster_colours(colours, cluster_count_choice{.most = 0}, 0),
                       doctest::Contains("at least one cluster"), gonio::error);
  CHECK_THROWS_WITH_AS((void)cluster_colours(point_matrix(50, 4), 1, 0), doctest::Contains("50 x 4"), gonio::error);
  CHECK_THROWS_AS((void)cluster_colours(point_matrix(0, 3), 1, 0), gonio::error);
  CHECK_THROWS_WITH_AS((void)cluster_colours(-colours, 1, 0), doctest::Contains("black"), gonio::error);
  colours(4, 1) = std::nan("");
  CHECK_THROWS_WITH_AS((void)cluster_colours(colours, 1, 0), "the colour of pixel 5 is not finite", gonio::error);
}
