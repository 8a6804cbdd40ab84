#include <gonio/core/progress.hpp>

#include <doctest/doctest.h>

TEST_CASE("a report reaches its listener, and none is needed") {
  std::string_view heard;
  double done = 0;
  gonio::report([&](std::string_view stage, double fraction) { heard = stage, done = fraction; }, "gram", 0.5);
  CHECK(heard == "gram");
  CHECK(done == 0.5);
  gonio::report({}, "gram", 1.0);
}
