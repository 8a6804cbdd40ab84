#include "../golden.hpp"
#include "location_free.hpp"
#include <gonio/metric/log.hpp>

TEST_CASE("ln(1 + x) agrees with the reference, and is continued as an odd function") {
  check_location_free(gonio::log{});
  const auto golden = golden_csv("metrics.csv");
  for (std::size_t i = 0; i < golden.at("x").size(); ++i)
    CHECK(gonio::log::map(golden.at("x")[i]) == doctest::Approx(golden.at("log1p")[i]).epsilon(1e-15));
  CHECK(gonio::log::map(-1.0) == -std::log(2.0));
}

TEST_CASE("whole arrays are mapped back to within 5e-7 of each value, from the smallest to the largest") {
  double worst = 0.0;
  for (double exponent = -40.0; exponent < 6.4; exponent += 0.01) {
    Eigen::Array<float, 3, 5> values;
    for (int i = 0; i < 15; ++i) values.reshaped()[i] = static_cast<float>(std::exp2(exponent) * (1.0 + 4e-4 * i));
    const Eigen::Array<double, 3, 5> expected = values.cast<double>().unaryExpr(&gonio::log::unmap);
    gonio::log::unmap_all({values.data(), 15});
    worst = std::max(worst, ((values.cast<double>() - expected) / expected).abs().maxCoeff());
  }
  CHECK(worst < 5e-7);
  Eigen::Array4f edges(0.0f, -3.0f, 0.5f, 100.0f);
  gonio::log::unmap_all({edges.data(), 4});
  CHECK(edges[0] == 0.0f);
  CHECK(edges[1] == 0.0f);
  CHECK(double{edges[2]} == doctest::Approx(std::expm1(0.5)).epsilon(5e-7));
  CHECK(edges[3] > std::numeric_limits<float>::max());
}
