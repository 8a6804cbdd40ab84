#include <gonio/estimate/scaled_likelihood.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

using gonio::outlier_mixture;

TEST_CASE("factor and likelihood: as likely as with the mixture that the differences were made with") {
  std::mt19937_64 generator(4);
  std::student_t_distribution<double> student(outlier_mixture::degrees_of_freedom);
  std::uniform_real_distribution<double> uniform(-4.0, 4.0);
  constexpr double share = 0.6, factor = 0.7;
  for (const double scale : {0.05, 0.3}) {
    std::vector<double> differences;
    for (int i = 0; i < 1000; ++i)
      differences.push_back(i < 600 ? factor + scale * student(generator) : uniform(generator));
    const std::vector<double> outliers(differences.size(), 0.125);  // the density of the uniform outliers
    const auto found = gonio::detail::best_factor(differences, outliers);
    CAPTURE(scale);
    CHECK(found.logarithm_of_factor == doctest::Approx(factor).epsilon(0.1 * scale));
    const outlier_mixture made{share, scale};
    double expected = 0.0;
    for (const double each : differences)
      expected += std::log(share * made.inlier_density(each - factor) + (1.0 - share) * 0.125);
    CHECK(found.log_likelihood > expected - 1.0);
    CHECK(found.log_likelihood < expected + 10.0);  // three fitted numbers gain little
  }
}

TEST_CASE("factor and likelihood: differences that are all equal have a likelihood that is finite") {
  const auto found = gonio::detail::best_factor(std::vector<double>(20, 0.25), std::vector<double>(20, 0.2));
  CHECK(found.logarithm_of_factor == doctest::Approx(0.25));
  CHECK(std::isfinite(found.log_likelihood));
}
