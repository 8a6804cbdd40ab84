#include <gonio/design/published_directions.hpp>
#include <gonio/table/valid_cells.hpp>

#include <doctest/doctest.h>

TEST_CASE("the published directions are above the horizon and as many as asked for") {
  for (const std::size_t n : gonio::nielsen_direction_counts) {
    const auto directions = gonio::nielsen_directions(n);
    CHECK(directions.size() == n);
    for (const auto& angles : directions) {
      const auto cosine = gonio::cosines(angles);
      CHECK(cosine.i > 0.0);
      CHECK(cosine.o > 0.0);
    }
  }
  CHECK(gonio::degrees(gonio::nielsen_directions(20)[19].theta_d) == doctest::Approx(43));
  CHECK(gonio::degrees(gonio::nielsen_directions(1)[0].theta_d) == doctest::Approx(66));
}

TEST_CASE("a number that is not in the table is refused") {
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::nielsen_directions(3)), doctest::Contains("1, 2, 5, 10 or 20"),
                       gonio::error);
}
