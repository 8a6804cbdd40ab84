#include <gonio/core/assertion.hpp>
#include <gonio/core/error.hpp>

#include <doctest/doctest.h>

TEST_CASE("an error carries its sentence and is a runtime_error") {
  const auto fail = [] { throw gonio::error("paint.csv, line 3: weight is negative"); };
  CHECK_THROWS_WITH_AS(fail(), "paint.csv, line 3: weight is negative", gonio::error);
  CHECK_THROWS_AS(fail(), std::runtime_error);
}

TEST_CASE("a refusal is an error of its parts, in which control characters are written out") {
  CHECK_THROWS_WITH_AS(gonio::refuse({"row ", 3, " has ", 2.5, " values"}), "row 3 has 2.500000 values", gonio::error);
  CHECK_THROWS_WITH_AS(gonio::refuse("file '\x1b[2J'"), "file '\\x1b[2J'", gonio::error);
  CHECK_THROWS_WITH_AS(gonio::refuse({"file '", std::string("\x07"), "'"}), "file '\\x07'", gonio::error);
}
