#include <gonio/core/statistics.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <vector>

TEST_CASE("quantiles and medians are those of the sorted numbers") {
  CHECK(rc::check([] {
    auto numbers = *rc::gen::nonEmpty(rc::gen::container<std::vector<double>>(
        rc::gen::map(rc::gen::inRange(-50, 50), [](int number) { return 0.25 * number; })));
    auto sorted = numbers;
    std::ranges::sort(sorted);
    const double share = 0.01 * *rc::gen::inRange(0, 101);
    const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1));
    RC_ASSERT(gonio::nth_smallest(numbers, at) == sorted[at]);
    RC_ASSERT(gonio::quantile(numbers, share) == sorted[at]);
    const std::size_t middle = sorted.size() / 2;
    RC_ASSERT(gonio::upper_median(numbers) == sorted[middle]);
    const double lower = sorted.size() % 2 == 0 ? sorted[middle - 1] : sorted[middle];
    RC_ASSERT(gonio::median(numbers) == 0.5 * (lower + sorted[middle]));
    std::ranges::sort(numbers);
    RC_ASSERT(numbers == sorted);  // only reordered
  }));
}

TEST_CASE("the least and the greatest; a temporary is a vector, too") {
  std::vector<int> numbers{4, 1, 3};
  CHECK(gonio::quantile(numbers, 0.0) == 1);
  CHECK(gonio::quantile(numbers, 1.0) == 4);
  CHECK(gonio::median(std::vector<float>{2.0f, 1.0f}) == 1.5f);
}

TEST_CASE("half of all normal numbers are within a median's distance of the mean") {
  // For a standard normal variable, P(|x| < d) = erf(d / sqrt(2)).
  CHECK(std::erf(1.0 / gonio::deviation_by_median / std::sqrt(2.0)) == doctest::Approx(0.5).epsilon(1e-4));
}
