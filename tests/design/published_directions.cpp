#include <gonio/design/published_directions.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/table/valid_cells.hpp>

#include <doctest/doctest.h>

#include <string>

TEST_CASE("the published directions are above the horizon and as many as asked for") {
  for (const Eigen::Index n : gonio::design::nielsen_direction_counts) {
    const auto directions = gonio::design::nielsen_directions(n);
    CHECK(directions.size() == n);
    for (const auto& angles : directions) {
      const auto cosine = gonio::cosines(angles);
      CHECK(cosine.i > 0.0);
      CHECK(cosine.o > 0.0);
    }
  }
  CHECK(gonio::degrees(gonio::design::nielsen_directions(20)[19].theta_d) == doctest::Approx(43));
  CHECK(gonio::degrees(gonio::design::nielsen_directions(1)[0].theta_d) == doctest::Approx(66));
}

TEST_CASE("the published directions are those of the shipped files") {
  for (const Eigen::Index n : gonio::design::nielsen_direction_counts) {
    const auto directions = gonio::design::nielsen_directions(n);
    const auto shipped = gonio::io::read_direction_pairs(
        std::string(GONIO_SOURCE_DIR) + "/examples/data/directions/point-" + std::to_string(n) + "-published.csv");
    REQUIRE(shipped.size() == directions.size());
    for (std::size_t i = 0; i < shipped.size(); ++i) {
      const auto pair = gonio::to_directions(directions[i]);
      CHECK(gonio::angle_between(pair.wi, shipped[i].wi) < 1e-6);
      CHECK(gonio::angle_between(pair.wo, shipped[i].wo) < 1e-6);
    }
  }
}

TEST_CASE("a number that is not in the table is refused") {
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::design::nielsen_directions(3)), doctest::Contains("1, 2, 5, 10 or 20"),
                       gonio::error);
}

TEST_CASE("industry's directions are in the plane of the light, whose angle from the mirror direction they state") {
  const auto directions = gonio::design::westlund_meyer_directions();
  REQUIRE(directions.size() == 5);
  const std::array aspecular{15.0, 25.0, 45.0, 75.0, 110.0};
  for (Eigen::Index i = 0; i < 5; ++i) {
    // In the plane of incidence, theta_h is half the angle between viewer and mirror direction.
    CHECK(gonio::degrees(directions[i].theta_h) == doctest::Approx(aspecular[i] / 2.0));
    const auto pair = gonio::to_directions(directions[i]);
    CHECK(pair.wi.y() == doctest::Approx(0.0));
    const auto near_45 = [](const gonio::direction& w) {
      return std::abs(gonio::degrees(std::acos(w.z())) - 45) < 1e-6;
    };
    CHECK((near_45(pair.wi) || near_45(pair.wo)));
  }
}

TEST_CASE("images of a sphere are given by theta_d") {
  const auto two = gonio::design::nielsen_sphere_directions(2);
  REQUIRE(two.size() == 2);
  CHECK(gonio::degrees(two[0].theta_d) == doctest::Approx(4.0));
  CHECK(gonio::degrees(two[1].theta_d) == doctest::Approx(70.0));
  CHECK(two[1].theta_h == 0.0);
  CHECK(gonio::design::nielsen_sphere_directions(1).size() == 1);
  CHECK(gonio::degrees(gonio::design::nielsen_sphere_directions(5)[4].theta_d) == doctest::Approx(75.0));
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::design::nielsen_sphere_directions(3)),
                       doctest::Contains("choose 1, 2 or 5"), gonio::error);
}
