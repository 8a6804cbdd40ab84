#include "papers/nielsen2015/few_samples.hpp"

#include "../synthetic_materials.hpp"
#include <gonio/evaluate/test_materials.hpp>

#include <doctest/doctest.h>

#include <array>

TEST_CASE("more directions are better, and the projection is better still") {
  const gonio::valid_cells cells(gonio::grid({24, 15, 18}));
  const auto prior = learn(synthetic_materials(cells, 12), 20);
  const auto truths = synthetic_materials(cells, 2, 4711);
  const gonio::appearance_metric judge(cells, 12);
  std::vector<gonio::half_difference> directions{
      {0.02, 0.5, 0.1}, {0.1, 0.9, 1.0}, {0.6, 0.3, 1.5}, {0.05, 0.1, 2.0}, {0.3, 1.0, 1.6}};
  const auto error = [&](std::size_t count) {
    const auto results = papers::reconstruct_from_directions(prior, 1e-3, std::span(directions).first(count), truths,
                                                             prior.metric(), judge);
    REQUIRE(results.size() == 2);
    CHECK(results[1].name == "material-1");
    return papers::mean_over(results, [](const auto& e) { return e.mapped_rms.mean(); });
  };
  const auto bound =
      papers::mean_over(papers::project_on(prior, truths, judge), [](const auto& e) { return e.mapped_rms.mean(); });
  CHECK(error(5) < error(1));
  CHECK(bound < error(5));
}

TEST_CASE("the test materials of Nielsen et al. are ten") { CHECK(gonio::nielsen_test_materials().size() == 10); }
