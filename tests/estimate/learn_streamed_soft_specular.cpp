#include "../synthetic_materials.hpp"
#include <gonio/estimate/learn_streamed_soft_specular.hpp>
#include <gonio/estimate/soft_specular_decomposition.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

namespace {

/// Materials on a grid whose first cells are in the default peak, up to 5 degrees.
gonio::material_set thirteen_materials() {
  return synthetic_materials(gonio::valid_cells(gonio::grid({12, 6, 9})), 13);
}

double difference(const gonio::log_relative_pca& a, const gonio::log_relative_pca& b) {
  REQUIRE(a.names() == b.names());
  REQUIRE(a.size() == b.size());
  return (a.components() - b.components()).cwiseAbs().maxCoeff() / b.components().cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("streamed halves are those of tables in memory") {
  for (const auto weighting : {gonio::cosine_weighting::product, gonio::cosine_weighting::larger}) {
    const auto set = thirteen_materials();
    const auto metric = gonio::log_relative::to_median_of(set).weighted_by(weighting);
    const auto known = gonio::learn_soft_specular_prior(set, metric, 5);
    const auto found =
        gonio::learn_streamed_soft_specular(gonio::rows_of(set), {.components = 5, .weighting = weighting});
    CHECK(found.exact);
    CHECK(found.residual == 0.0);
    CHECK(found.prior.threshold() == doctest::Approx(known.threshold()).epsilon(1e-12));
    CHECK(std::ranges::equal(found.prior.metric().reference(), known.metric().reference()));
    CHECK(difference(found.prior.soft(), known.soft()) < 1e-5);
    CHECK(difference(found.prior.specular(), known.specular()) < 1e-5);
    CHECK(found.prior.soft().mean() == known.soft().mean());
    CHECK(found.prior.specular().singular_values().isApprox(known.specular().singular_values(), 1e-9));
  }
}

TEST_CASE("streamed halves: a threshold, threads and a random subspace") {
  const auto set = thirteen_materials();
  const auto rows = gonio::rows_of(set);
  const auto one = gonio::learn_streamed_soft_specular(rows, {.components = 4, .threads = {1}});
  const auto three = gonio::learn_streamed_soft_specular(rows, {.components = 4, .threads = {3}});
  CHECK(one.prior.threshold() == three.prior.threshold());
  CHECK(one.prior.soft().components() == three.prior.soft().components());
  CHECK(one.prior.specular().components() == three.prior.specular().components());
  const auto subspace = gonio::learn_streamed_soft_specular(rows, {.components = 4, .exact_columns = 5});
  CHECK_FALSE(subspace.exact);
  CHECK(subspace.residual > 0.0);
  CHECK(subspace.residual < 1e-4);
  // All materials except the shiniest.
  const auto metric = gonio::log_relative::to_median_of(set);
  const auto contrasts = gonio::highlight_contrasts(metric, set);
  const double high = contrasts.maxCoeff() - 1e-9;
  CHECK_THROWS_WITH_AS((void)gonio::learn_streamed_soft_specular(rows, {}, high + 1.0),
                       doctest::Contains("all 13 materials are soft"), gonio::error);
  CHECK(gonio::learn_streamed_soft_specular(rows, {.components = 4}, high).prior.soft().names().size() == 12);
}

TEST_CASE("materials that cannot be parted are refused") {
  auto set = thirteen_materials();
  CHECK_THROWS_AS((void)gonio::learn_streamed_soft_specular({set.cells, {}, {}}), gonio::error);
  set.values(0, 4) = std::numeric_limits<float>::quiet_NaN();
  const gonio::material_rows rows{set.cells, set.names, [&](gonio::block range, gonio::cell_rows out) {
                                    out = set.values.middleRows(range.begin, range.size());
                                  }};
  CHECK_THROWS_WITH_AS((void)gonio::learn_streamed_soft_specular(rows), doctest::Contains("'material-1'"),
                       gonio::error);
  // On a grid without cells in the peak.
  const auto coarse = synthetic_materials(gonio::valid_cells(gonio::grid({2, 4, 6})), 4);
  CHECK_THROWS_WITH_AS((void)gonio::learn_streamed_soft_specular(gonio::rows_of(coarse)),
                       doctest::Contains("too coarse"), gonio::error);
}
