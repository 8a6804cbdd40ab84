#include "../golden.hpp"
#include "location_free.hpp"
#include <gonio/metric/lin.hpp>

TEST_CASE("the linear metric is the reflectance itself, negative too") {
  check_location_free(gonio::lin{});
  const auto golden = golden_csv("metrics.csv");
  for (std::size_t i = 0; i < golden.at("x").size(); ++i)
    CHECK(gonio::lin::map(golden.at("x")[i]) == golden.at("lin")[i]);
  CHECK(gonio::lin::map(-3.0) == -3.0);
}
