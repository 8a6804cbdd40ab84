#include <gonio/core/assertion.hpp>
#include <gonio/core/error.hpp>

#include <doctest/doctest.h>

TEST_CASE("an error carries its sentence and is a runtime_error") {
  const auto fail = [] { throw gonio::error("paint.csv, line 3: weight is negative"); };
  CHECK_THROWS_WITH_AS(fail(), "paint.csv, line 3: weight is negative", gonio::error);
  CHECK_THROWS_AS(fail(), std::runtime_error);
}
