#include "../golden.hpp"
#include "location_free.hpp"
#include <gonio/metric/root.hpp>

using gonio::root;

TEST_CASE("the square root agrees with the reference, and is continued as an odd function") {
  check_location_free(root{});
  const auto golden = golden_csv("metrics.csv");
  for (std::size_t i = 0; i < golden.at("x").size(); ++i)
    CHECK(root{}.map(golden.at("x")[i]) == doctest::Approx(golden.at("root")[i]).epsilon(1e-15));
  CHECK(root{}.map(-9.0) == -3.0);
}

TEST_CASE("any root of at least 1") {
  check_location_free(root{3.0});
  check_location_free(root{1.7});
  check_location_free(root{1.0});
  CHECK(root{3.0}.map(-8.0) == doctest::Approx(-2.0));
  CHECK(root{3.0}.p() == 3.0);
}

TEST_CASE("other roots are refused") {
  for (const double p : {0.0, 0.5, -2.0, std::nan(""), HUGE_VAL}) CHECK_THROWS_AS(root{p}, gonio::error);
}
