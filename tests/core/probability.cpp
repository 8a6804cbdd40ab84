#include <gonio/core/error.hpp>
#include <gonio/core/probability.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

// Tables of chi-square and F, as in any textbook.
TEST_CASE("quantiles are those of the tables") {
  CHECK(gonio::chi_square_quantile(0.95, 3.0) == doctest::Approx(7.8147).epsilon(1e-5));
  CHECK(gonio::chi_square_quantile(0.999, 1.0) == doctest::Approx(10.828).epsilon(1e-4));
  CHECK(gonio::chi_square_quantile(0.999, 10.0) == doctest::Approx(29.588).epsilon(1e-4));
  CHECK(gonio::chi_square_quantile(0.999, 100.0) == doctest::Approx(149.449).epsilon(1e-5));
  CHECK(gonio::f_quantile(0.95, 3.0, 10.0) == doctest::Approx(3.7083).epsilon(1e-4));
  CHECK(gonio::f_quantile(0.95, 3.0, 120.0) == doctest::Approx(2.6802).epsilon(1e-4));
  CHECK(3.0 * gonio::f_quantile(0.95, 3.0, 1e6) == doctest::Approx(7.8147).epsilon(1e-4));
}

TEST_CASE("shares that are not between 0 and 1 are refused") {
  CHECK_THROWS_WITH_AS(gonio::chi_square_quantile(1.0, 3.0), "a probability must be above 0 and below 1, not 1.000000",
                       gonio::error);
  CHECK_THROWS_AS(gonio::f_quantile(0.0, 3.0, 3.0), gonio::error);
}

TEST_CASE("upper tails are those of closed forms, however small") {
  // Upper tails: exp(-x / 2) for 2 degrees of freedom, erfc(sqrt(x / 2)) for 1.
  for (const double x : {0.1, 1.0, 10.0, 100.0, 500.0}) {
    CHECK(gonio::chi_square_tail(x, 2.0) == doctest::Approx(std::exp(-0.5 * x)).epsilon(1e-9));
    CHECK(gonio::chi_square_tail(x, 1.0) == doctest::Approx(std::erfc(std::sqrt(0.5 * x))).epsilon(1e-9));
    CHECK(gonio::f_tail(x, 2.0, 4.0) == doctest::Approx(std::pow(1.0 + 0.5 * x, -2.0)).epsilon(1e-9));
  }
  CHECK(gonio::chi_square_tail(0.0, 3.0) == 1.0);
  CHECK(gonio::chi_square_tail(-1.0, 3.0) == 1.0);
  CHECK(gonio::f_tail(-1.0, 3.0, 4.0) == 1.0);
}

TEST_CASE("the tail above a quantile is the complement of its share") {
  for (const double freedom : {1.0, 3.0, 15.0, 60.0}) {
    CHECK(gonio::chi_square_tail(gonio::chi_square_quantile(0.99, freedom), freedom) == doctest::Approx(0.01));
    CHECK(gonio::f_tail(gonio::f_quantile(0.99, freedom, 7.0), freedom, 7.0) == doctest::Approx(0.01));
    const double infinite = std::numeric_limits<double>::infinity();
    CHECK(gonio::f_tail(2.0, freedom, infinite) == gonio::chi_square_tail(2.0 * freedom, freedom));
    CHECK(gonio::f_tail(2.0, freedom, 1e7) == doctest::Approx(gonio::f_tail(2.0, freedom, infinite)).epsilon(1e-4));
  }
}
