#include "synthetic_candidates.hpp"
#include <gonio/design/exhaustive_search.hpp>

#include <doctest/doctest.h>

namespace {

/// Returns the best pair, found by trying all.
gonio::design::capture_plan best_pair(const gonio::design::cell_candidates& candidates) {
  gonio::design::capture_plan best;
  for (Eigen::Index a = 0; a < candidates.size(); ++a) {
    const std::vector<float> errors = candidates.errors_with_each(std::vector<Eigen::Index>{a});
    const Eigen::Index b = std::ranges::min_element(errors) - errors.begin();
    const std::vector<Eigen::Index> pair{a, b};
    if (const double value = candidates(pair); value < best.value) best = {pair, value};
  }
  return best;
}

}  // namespace

TEST_CASE("the first cell of greedy growth is the best of all; each error is less than the last") {
  const auto candidates = synthetic_candidates();
  const auto one = gonio::design::grow_greedily(candidates, 1);
  for (Eigen::Index cell = 0; cell < candidates.size(); ++cell)
    CHECK(one.value <= candidates(std::vector<Eigen::Index>{cell}) * (1.0 + 1e-6));
  const auto three = gonio::design::grow_greedily(candidates, 3),
             five = gonio::design::grow_greedily(candidates, 5, three);
  CHECK(three.candidates[0] == one.candidates[0]);
  CHECK(three.value < one.value);
  CHECK(five.value < three.value);
  CHECK(five.candidates == gonio::design::grow_greedily(candidates, 5).candidates);
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::design::grow_greedily(candidates, 0)),
                       doctest::Contains("cannot choose 0"), gonio::error);
  CHECK_THROWS_AS(static_cast<void>(gonio::design::grow_greedily(candidates, candidates.size() + 1)), gonio::error);
}

namespace {

/// Searches the candidates in two parts, as two processes would.
struct in_two_parts {
  const gonio::design::cell_candidates& whole;
  mutable int asked = 0;

  [[nodiscard]] const auto& geometry() const { return whole.geometry(); }
  double operator()(std::span<const Eigen::Index> candidates) const { return whole(candidates); }
  [[nodiscard]] std::vector<float> errors_with_each(std::span<const Eigen::Index> candidates) const {
    return whole.errors_with_each(candidates);
  }
  [[nodiscard]] Eigen::Index best_beside(std::span<const Eigen::Index> candidates) const {
    ++asked;
    std::vector<float> errors = whole.errors_with_each(candidates, {0, 128});
    for (const float error : whole.errors_with_each(candidates, {128, whole.size()})) errors.push_back(error);
    for (const Eigen::Index each : candidates) errors[each] = std::numeric_limits<float>::infinity();
    return std::ranges::min_element(errors) - errors.begin();
  }
};

}  // namespace

TEST_CASE("an objective that finds the best by itself is asked, and the search is the same") {
  const auto candidates = synthetic_candidates();
  const in_two_parts parts{candidates};
  const auto expected = gonio::design::exchange(candidates, gonio::design::grow_greedily(candidates, 3));
  const auto found = gonio::design::exchange(parts, gonio::design::grow_greedily(parts, 3));
  CHECK(found.candidates == expected.candidates);
  CHECK(found.value == expected.value);
  CHECK(parts.asked >= 6);
}

TEST_CASE("two cells: exchange from the greedy pair comes to the best pair of all, or next to it") {
  const auto candidates = synthetic_candidates();
  const auto best = best_pair(candidates);
  const auto greedy = gonio::design::grow_greedily(candidates, 2),
             exchanged = gonio::design::exchange(candidates, greedy);
  CHECK(exchanged.value <= greedy.value);
  CHECK(exchanged.value >= best.value * (1.0 - 1e-6));
  CHECK(exchanged.value <= best.value * 1.02);
  double of_many = exchanged.value;
  for (const Eigen::Index start : {Eigen::Index{10}, Eigen::Index{150}, Eigen::Index{300}})
    of_many = std::min(of_many, gonio::design::exchange(candidates, {{start, start + 20}}).value);
  CHECK(of_many == doctest::Approx(best.value).epsilon(1e-6));
}

TEST_CASE("after exchange no single replacement improves") {
  const auto candidates = synthetic_candidates({.eta = 0.1, .common_shift = 0.2});
  const auto found = gonio::design::exchange(candidates, gonio::design::grow_greedily(candidates, 4));
  for (Eigen::Index position = 0; position < 4; ++position)
    for (Eigen::Index cell = 0; cell < candidates.size(); ++cell) {
      auto other = found.candidates;
      other[position] = cell;
      CHECK(candidates(other) >= found.value * (1.0 - 1e-5));
    }
}

TEST_CASE("cells that the constraint excludes are no candidates") {
  gonio::design::capture_constraint constraint;
  constraint.light.largest = gonio::radians(40);
  const gonio::design::cell_candidates candidates(
      candidate_basis(), gonio::design::expected_error(candidate_basis(), {.eta = 0.5}), constraint);
  const auto found = gonio::design::exchange(candidates, gonio::design::grow_greedily(candidates, 4));
  for (const Eigen::Index cell : found.candidates) {
    const gonio::direction_pair pair = gonio::to_directions(small_cells().angles(cell));
    CHECK(std::max(pair.wi.z(), pair.wo.z()) >= std::cos(gonio::radians(40.001)));
  }
  constraint.light.smallest = constraint.light.largest = gonio::radians(39.123);
  CHECK_THROWS_WITH_AS(
      static_cast<void>(gonio::design::grow_greedily(
          gonio::design::cell_candidates(candidate_basis(), gonio::design::expected_error(candidate_basis()),
                                         constraint),
          1)),
      doctest::Contains("the rule 'light' of the apparatus leaves no direction to measure: relax this rule"),
      gonio::error);
}
