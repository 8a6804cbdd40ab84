#include "../synthetic_materials.hpp"
#include <gonio/estimate/soft_specular_decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <doctest/doctest.h>

namespace {

/// A grid whose first cells are in the default peak, up to 5 degrees.
const gonio::valid_cells& cells_with_peak() {
  static const gonio::valid_cells cells(gonio::grid({12, 6, 9}));
  return cells;
}

const gonio::material_set& halved_materials() {
  static const auto set = synthetic_materials(cells_with_peak(), 13);
  return set;
}

const gonio::log_relative& median_of_all() {
  static const auto metric = gonio::log_relative::to_median_of(halved_materials());
  return metric;
}

}  // namespace

TEST_CASE("both halves are learned relative to the reference of all, and parted by contrast") {
  const auto prior = gonio::learn_soft_specular_prior(halved_materials(), median_of_all(), 5);
  const auto [soft, specular, threshold] = gonio::split_by_contrast(halved_materials(), median_of_all());
  CHECK(prior.threshold() == threshold);
  CHECK(prior.soft().names() == soft.names);
  CHECK(prior.specular().names() == specular.names);
  CHECK(prior.soft().components() == gonio::learn_pca(soft, median_of_all(), 5).components());
  CHECK(prior.specular().components() == gonio::learn_pca(specular, median_of_all(), 5).components());
  CHECK(gonio::learn_soft_specular_prior(halved_materials(), median_of_all(), 5, {}, {1}).specular().components() ==
        gonio::learn_soft_specular_prior(halved_materials(), median_of_all(), 5, {}, {3}).specular().components());
}

TEST_CASE("penalties are in proportion to the materials, and add up") {
  const auto prior = gonio::learn_soft_specular_prior(halved_materials(), median_of_all(), 5);
  REQUIRE(prior.materials() == 13);
  const auto penalties = gonio::penalties_in_proportion(prior, 26.0);
  CHECK(penalties.soft == doctest::Approx(2.0 * static_cast<double>(prior.soft().names().size())));
  CHECK(penalties.soft + penalties.specular == doctest::Approx(26.0));
}

TEST_CASE("the estimate is the ridge reconstruction by the half that the samples choose") {
  const auto prior = gonio::learn_soft_specular_prior(halved_materials(), median_of_all(), 5);
  const auto penalties = gonio::penalties_in_proportion(prior, 4.0);
  const auto estimator = gonio::soft_specular_decomposition(prior, penalties);
  int soft = 0;
  for (Eigen::Index m = 0; m < prior.materials(); ++m) {
    const auto samples =
        gonio::sample_table(halved_materials().table(m), gonio::random_cells(cells_with_peak(), 80, m));
    const auto fit = estimator.fit(samples);
    const bool is_soft = *gonio::highlight_contrast(median_of_all(), samples) < prior.threshold();
    CHECK((fit.kind() == gonio::material_kind::soft) == is_soft);
    soft += is_soft ? 1 : 0;
    const auto expected = gonio::decomposition{is_soft ? prior.soft() : prior.specular(),
                                               gonio::tikhonov{is_soft ? penalties.soft : penalties.specular}}
                              .fit(samples)
                              .tabulate(cells_with_peak());
    CHECK(std::ranges::equal(fit.tabulate(cells_with_peak()).values(), expected.values()));
  }
  CHECK(soft > 2);
  CHECK(soft < 11);
}

TEST_CASE("materials and penalties that cannot be used are refused") {
  CHECK_THROWS_WITH_AS((void)gonio::learn_soft_specular_prior(halved_materials(), median_of_all(), 5, 1e6),
                       doctest::Contains("all 13 materials are soft"), gonio::error);
  CHECK_THROWS_AS((void)gonio::learn_soft_specular_prior(halved_materials(), median_of_all(), 0), gonio::error);
  const auto prior = gonio::learn_soft_specular_prior(halved_materials(), median_of_all(), 5);
  CHECK_THROWS_AS((void)gonio::soft_specular_decomposition(prior, {0.0, 1.0}), gonio::error);
  CHECK_THROWS_AS((void)gonio::soft_specular_decomposition(prior, {1.0, std::nan("")}), gonio::error);
}
