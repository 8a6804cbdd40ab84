#include "synthetic_candidates.hpp"
#include <gonio/design/cell_candidates.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

namespace {

/// Penalties of zero at some cells, much larger than eta at others.
std::vector<double> synthetic_sample_noise_penalties() {
  std::vector<double> etas(small_cells().size());
  for (Eigen::Index cell = 0; cell < std::ssize(etas); ++cell) etas[cell] = static_cast<double>(cell % 7 * (cell % 5));
  return etas;
}

}  // namespace

TEST_CASE("all additions at once are what each is by itself") {
  const std::vector<double> none, some = synthetic_sample_noise_penalties();
  for (const auto& [noise, common_shift, leave_out, sample_noise_penalties] :
       {std::tuple{0.0, 0.0, false, none}, std::tuple{0.0, 0.4, false, none}, std::tuple{0.0, 0.0, false, some},
        std::tuple{0.1, 0.4, false, some}, std::tuple{0.0, 0.0, true, none}, std::tuple{0.1, 0.4, true, some}}) {
    // eta is as large relative to the rows of Y as for real materials. If it is much smaller, K is too ill-conditioned
    // for float.
    const auto candidates = synthetic_candidates(
        {.eta = 4.0, .noise = noise, .common_shift = common_shift, .leave_out = leave_out}, {}, sample_noise_penalties);
    REQUIRE(candidates.size() == small_cells().size());
    CHECK(rc::check("random designs", [&] {
      const auto any = rc::gen::inRange<Eigen::Index>(0, candidates.size());
      const auto n = *rc::gen::inRange<Eigen::Index>(0, 8);
      const auto cells = *rc::gen::container<std::vector<Eigen::Index>>(n, any);
      const std::vector<float> errors = candidates.errors_with_each(cells);
      RC_ASSERT(std::ssize(errors) == candidates.size());
      auto longer = cells;
      longer.push_back(0);
      for (Eigen::Index cell = 0; cell < candidates.size(); cell += 13) {
        longer.back() = cell;
        const double alone = candidates(longer);
        RC_ASSERT(std::abs(double{errors[cell]} - alone) < 1e-4 * alone);
      }
    }));
  }
}

TEST_CASE("one more beside some is what all of them are") {
  for (const bool leave_out : {false, true}) {
    const auto candidates =
        synthetic_candidates({.eta = 0.3, .noise = 0.05, .common_shift = 0.1, .leave_out = leave_out});
    const std::vector<Eigen::Index> cells{4, 90, 301};
    const auto with = candidates.beside(cells);
    for (Eigen::Index cell = 0; cell < candidates.size(); cell += 17) {
      const std::vector<Eigen::Index> all{4, 90, 301, cell};
      CHECK(with(cell) == doctest::Approx(candidates(all)).epsilon(1e-5));  // Y and W are rounded to float
    }
  }
}

TEST_CASE("the same bytes for any number of threads") {
  const std::vector<Eigen::Index> cells{4, 90, 301};
  const auto one = synthetic_candidates({.eta = 2.0, .common_shift = 0.1}, {1}),
             three = synthetic_candidates({.eta = 2.0, .common_shift = 0.1}, {3});
  CHECK(one.errors_with_each(cells) == three.errors_with_each(cells));
  CHECK(one(cells) == three(cells));
}

TEST_CASE("a range of a sweep has the bytes of the whole") {
  const std::vector<Eigen::Index> cells{4, 90, 301};
  const auto candidates = synthetic_candidates({.eta = 2.0, .common_shift = 0.1});
  const std::vector<float> all = candidates.errors_with_each(cells);
  const Eigen::Index half = gonio::design::cell_candidates::sweep_block;
  REQUIRE(half < candidates.size());
  std::vector<float> both = candidates.errors_with_each(cells, {0, half});
  for (const float error : candidates.errors_with_each(cells, {half, candidates.size()})) both.push_back(error);
  CHECK(both == all);
  CHECK(candidates.errors_with_each(cells, {half, half}).empty());
}

TEST_CASE("errors of their own are those of all cells, and sensible") {
  std::vector<double> etas = synthetic_sample_noise_penalties();
  etas.pop_back();
  CHECK_THROWS_WITH_AS(synthetic_candidates({}, {}, etas), doctest::Contains("per-cell penalties, got"), gonio::error);
  etas.push_back(-1.0);
  CHECK_THROWS_WITH_AS(synthetic_candidates({}, {}, etas), doctest::Contains("not negative"), gonio::error);
}
