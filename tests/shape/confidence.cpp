#include <gonio/core/error.hpp>
#include <gonio/shape/confidence.hpp>

#include <doctest/doctest.h>

// Tables of chi-square and F, as any textbook has them.
TEST_CASE("quantiles are those of the tables") {
  CHECK(gonio::shape::chi_square_quantile(0.95, 3.0) == doctest::Approx(7.8147).epsilon(1e-5));
  CHECK(gonio::shape::chi_square_quantile(0.999, 1.0) == doctest::Approx(10.828).epsilon(1e-4));
  CHECK(gonio::shape::chi_square_quantile(0.999, 10.0) == doctest::Approx(29.588).epsilon(1e-4));
  CHECK(gonio::shape::chi_square_quantile(0.999, 100.0) == doctest::Approx(149.449).epsilon(1e-5));
  CHECK(gonio::shape::f_quantile(0.95, 3.0, 10.0) == doctest::Approx(3.7083).epsilon(1e-4));
  CHECK(gonio::shape::f_quantile(0.95, 3.0, 120.0) == doctest::Approx(2.6802).epsilon(1e-4));
  CHECK(3.0 * gonio::shape::f_quantile(0.95, 3.0, 1e6) == doctest::Approx(7.8147).epsilon(1e-4));
}

TEST_CASE("shares that are none are refused") {
  CHECK_THROWS_WITH_AS(gonio::shape::chi_square_quantile(1.0, 3.0),
                       "a share of a distribution must be above 0 and below 1, not 1.000000", gonio::error);
  CHECK_THROWS_AS(gonio::shape::f_quantile(0.0, 3.0, 3.0), gonio::error);
}
