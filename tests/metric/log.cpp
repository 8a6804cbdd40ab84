#include "../golden.hpp"
#include "place_free.hpp"
#include <gonio/metric/log.hpp>

TEST_CASE("ln(1 + x) agrees with the reference, and is continued as an odd function") {
  check_place_free(gonio::log{});
  const auto golden = golden_csv("metrics.csv");
  for (std::size_t i = 0; i < golden.at("x").size(); ++i)
    CHECK(gonio::log::map(golden.at("x")[i]) == doctest::Approx(golden.at("log1p")[i]).epsilon(1e-15));
  CHECK(gonio::log::map(-1.0) == -std::log(2.0));
}
