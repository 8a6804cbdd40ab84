#include "../synthetic_materials.hpp"
#include <gonio/basis/soft_specular_prior.hpp>

#include <doctest/doctest.h>

#include <limits>

namespace {

/// Learns one prior from the first and one from the last materials of a set, both relative to the median of all.
gonio::soft_specular_prior two_of(const gonio::material_set& set) {
  const auto metric = gonio::log_relative::to_median_of(set);
  const auto half = [&](std::vector<Eigen::Index> chosen) { return gonio::learn_pca(set.subset(chosen), metric, 4); };
  return {half({0, 1}), half({2, 3, 4}), 0.25};
}

}  // namespace

TEST_CASE("two priors in one: their common members") {
  const auto prior = two_of(synthetic_materials(small_cells(), 5));
  CHECK(prior.materials() == 5);
  CHECK(prior.soft().names() == std::vector<std::string>{"material-0", "material-1"});
  CHECK(prior.specular().names().size() == 3);
  CHECK(prior.threshold() == 0.25);
  CHECK(prior.cells() == small_cells());
  CHECK(std::ranges::equal(prior.metric().reference(), prior.specular().metric().reference()));
  const auto named = prior.with_source("a laboratory");
  CHECK(named.soft().source() == "a laboratory");
  CHECK(named.specular().source() == "a laboratory");
}

TEST_CASE("two priors over fewer cells are the two priors thinned") {
  const gonio::valid_cells of_many(gonio::grid({10, 9, 15})), of_few(gonio::grid({10, 3, 5}));
  const auto prior = two_of(synthetic_materials(of_many, 5)), thinned = prior.on(of_few);
  CHECK(thinned.cells() == of_few);
  CHECK(thinned.threshold() == prior.threshold());
  CHECK(thinned.soft().components() == gonio::thin(prior.soft(), of_few).components());
  CHECK(thinned.specular().mean() == gonio::thin(prior.specular(), of_few).mean());
}

TEST_CASE("priors that do not belong together are refused") {
  const auto prior = two_of(synthetic_materials(small_cells(), 5));
  const auto refused = [&](const gonio::log_relative_pca& specular, double threshold, const char* why) {
    CHECK_THROWS_WITH_AS((void)gonio::soft_specular_prior(prior.soft(), specular, threshold), doctest::Contains(why),
                         gonio::error);
  };
  refused(prior.specular(), std::numeric_limits<double>::quiet_NaN(), "must be finite");
  refused(prior.specular(), std::numeric_limits<double>::infinity(), "must be finite");
  refused(learn(synthetic_materials(small_cells(), 5, 8), 4), 0.0, "relative to the same BRDF");
  refused(learn(synthetic_materials(gonio::valid_cells(gonio::grid({9, 7, 9})), 5), 4), 0.0, "the same cells");
  const auto& metric = prior.metric();
  refused(
      gonio::learn_pca(synthetic_materials(small_cells(), 5), metric.weighted_by(gonio::cosine_weighting::larger), 4),
      0.0, "relative to the same BRDF");
}
