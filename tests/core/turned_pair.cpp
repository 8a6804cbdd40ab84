#include <gonio/core/turned_pair.hpp>

#include <doctest/doctest.h>

using gonio::direction_pair;
using gonio::spherical_direction;
using gonio::turned_pair;

TEST_CASE("pairs that differ by a turn about the normal agree, also where an azimuth has no meaning") {
  const auto pair = [](double theta_i, double theta_o, double azimuth, double turn) {
    return turned_pair(
        direction_pair{spherical_direction(theta_i, turn), spherical_direction(theta_o, turn + azimuth)});
  };
  const turned_pair here = pair(0.3, 0.7, 2.0, 0.0);
  CHECK(here.agrees(pair(0.3, 0.7, 2.0, 5.0), 1e-9));
  CHECK_FALSE(here.agrees(pair(0.3, 0.7, -2.0, 0.0), 1e-3));
  CHECK_FALSE(here.agrees(pair(0.3, 0.71, 2.0, 0.0), 1e-3));
  CHECK(here.agrees(pair(0.7, 0.3, -2.0, 1.0).swapped(), 1e-9));
  // A turn moves the direction nearer to the normal by less.
  CHECK(here.agrees(pair(0.3, 0.7, 2.01, 0.0), 0.004));
  CHECK_FALSE(here.agrees(pair(0.3, 0.7, 2.01, 0.0), 0.002));
  CHECK(pair(0.0, 0.7, 0.0, 0.0).agrees(pair(0.0, 0.7, 1.0, 2.0), 1e-9));
}
