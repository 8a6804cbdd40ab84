#include "../golden.hpp"
#include "place_free.hpp"
#include <gonio/metric/lin.hpp>

TEST_CASE("the linear metric is the reflectance itself, negative too") {
  check_place_free(gonio::lin{});
  const auto golden = golden_csv("metrics.csv");
  for (std::size_t i = 0; i < golden.at("x").size(); ++i)
    CHECK(gonio::lin::map(golden.at("x")[i]) == golden.at("lin")[i]);
  CHECK(gonio::lin::map(-3.0) == -3.0);
}

TEST_CASE("the slope of lin is that of differences") {
  const gonio::lin metric{};
  for (const double rho : {-3.0, -0.2, 0.01, 0.4, 50.0}) {
    CAPTURE(rho);
    const double step = 1e-6 * std::abs(rho);
    const double difference = (metric.map(rho + step) - metric.map(rho - step)) / (2.0 * step);
    CHECK(metric.slope(rho) == doctest::Approx(difference).epsilon(1e-6));
  }
  CHECK(std::isfinite(metric.slope(0.0)));
}
