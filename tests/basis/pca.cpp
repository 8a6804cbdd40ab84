#include "../synthetic_materials.hpp"
#include <gonio/basis/pca.hpp>

#include <doctest/doctest.h>

static_assert(gonio::basis<gonio::log_relative_pca>);

namespace {

gonio::log_relative_pca small_prior() {
  return learn(synthetic_materials(gonio::valid_cells(gonio::grid({12, 6, 8})), 4), 6);
}

}  // namespace

TEST_CASE("every member of a principal component basis") {
  const auto prior = small_prior();
  CHECK(prior.size() == 6);
  CHECK(prior.row(3).size() == 6);
  CHECK(prior.row(3)[2] == prior.components()(3, 2));
  CHECK(prior.offset(3) == prior.mean()[3]);
  CHECK(prior.names().size() == 4);
  CHECK(prior.coefficients().rows() == 12);
  CHECK(prior.observations() == 12.0);
  CHECK(prior.singular_values()[0] > prior.singular_values()[5]);
  CHECK(prior.explained_variance() > 0.9);
  CHECK(prior.explained_variance() <= 1.0);
  CHECK(prior.with_source("a laboratory").source() == "a laboratory");
  CHECK(prior.source().empty());
}

TEST_CASE("copies share their storage") {
  const auto prior = small_prior(), copy = prior;
  CHECK(copy.row(0).data() == prior.row(0).data());
}

TEST_CASE("a truncated basis keeps the first components") {
  const auto prior = small_prior(), two = prior.truncated(2);
  CHECK(two.size() == 2);
  CHECK(two.row(5)[1] == prior.row(5)[1]);
  CHECK(two.weights_of(1).col(2) == prior.weights_of(1).col(2).head(2));
  CHECK(two.explained_variance() < prior.explained_variance());
  CHECK_THROWS_AS(static_cast<void>(prior.truncated(0)), gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(prior.truncated(7)), doctest::Contains("7 of 6"), gonio::error);
}

TEST_CASE("parts that do not match are refused") {
  const auto prior = small_prior();
  gonio::pca_parts<gonio::log_relative> parts{prior.cells(),           prior.metric(),     prior.names(),
                                              prior.singular_values(), prior.components(), std::vector<float>(3),
                                              prior.coefficients()};
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::log_relative_pca(parts)), doctest::Contains("do not match"),
                       gonio::error);
}
