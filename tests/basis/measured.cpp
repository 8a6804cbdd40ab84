#include "../synthetic_materials.hpp"
#include <gonio/basis/expand_materials.hpp>
#include <gonio/basis/measured.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>

#include <doctest/doctest.h>

using gonio::measured;

namespace {

/// Its mapped values overflow double.
struct overflowing_metric {
  double forward(double rho, const auto&) const noexcept { return std::exp(1e3 * (1.0 + rho)); }
  double inverse(double y, const auto&) const noexcept { return 1e-3 * std::log(y) - 1.0; }
};

}  // namespace

static_assert(gonio::basis<gonio::material_channel<gonio::log>>);
static_assert(gonio::channelwise_basis<measured<gonio::log>> && !gonio::basis<measured<gonio::log>>);
static_assert(gonio::colour_basis<measured<gonio::log_relative>> && gonio::colour_basis<gonio::log_relative_pca>);
static_assert(gonio::has_arbitrary_sign<gonio::log_relative_pca> && !gonio::has_arbitrary_sign<measured<gonio::log>>);

TEST_CASE("function i of a channel is that channel of material i, mapped") {
  const auto materials = synthetic_materials(small_cells(), 5);
  const measured basis{materials, gonio::log{}};
  CHECK(basis.size() == 5);
  CHECK(basis.names() == materials.names);
  for (const Eigen::Index cell : {Eigen::Index{0}, small_cells().size() / 2, small_cells().size() - 1})
    for (std::size_t c = 0; c < 3; ++c) {
      const auto channel = basis.channel(c);
      REQUIRE(channel.row(cell).size() == 5);
      CHECK(channel.offset(cell) == 0.0);
      for (std::size_t i = 0; i < 5; ++i)
        CHECK(channel.row(cell)[i] == doctest::Approx(std::log1p(materials.values(cell, 3 * i + c))));
    }
}

TEST_CASE("the products of a channel are its Gram matrix over all cells") {
  const measured basis{synthetic_materials(small_cells(), 4), gonio::lin{}};
  const auto channel = basis.channel(1);
  double sum = 0.0;
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell)
    sum += double{channel.row(cell)[2]} * double{channel.row(cell)[3]};
  CHECK(channel.products()(2, 3) == doctest::Approx(sum).epsilon(1e-12));
  const measured again{synthetic_materials(small_cells(), 4), gonio::lin{}};
  CHECK(channel.products({1}) == again.channel(1).products({3}));
}

TEST_CASE("materials are left out without copying: the rows stay where they are") {
  const measured basis{synthetic_materials(small_cells(), 5), gonio::log{}};
  const auto fewer = basis.without({"material-1", "material-4"}), fewest = fewer.without({"material-0"});
  CHECK(std::ranges::equal(basis.columns(), std::vector<Eigen::Index>{0, 1, 2, 3, 4}));
  CHECK(std::ranges::equal(fewer.columns(), std::vector<Eigen::Index>{0, 2, 3}));
  CHECK(std::ranges::equal(fewest.channel(2).columns(), std::vector<Eigen::Index>{2, 3}));
  CHECK(fewest.channel(0).row(7).data() == basis.channel(0).row(7).data());
  CHECK_THROWS_WITH_AS(static_cast<void>(basis.without({"material-9"})), doctest::Contains("material-9"), gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(fewest.without({"material-2", "material-3"})), doctest::Contains("all"),
                       gonio::error);
}

TEST_CASE("a basis of a prior's expanded materials equals that of the materials") {
  const auto materials = synthetic_materials(small_cells(), 6);
  const auto remembered = gonio::expand(learn(materials, 18));
  CHECK(remembered.names == materials.names);
  REQUIRE(remembered.values.rows() == materials.values.rows());
  CHECK((remembered.values - materials.values).cwiseAbs().maxCoeff() < 2e-3f * materials.values.maxCoeff());
  const measured from_prior{remembered, gonio::log{}}, from_materials{materials, gonio::log{}};
  for (Eigen::Index cell = 0; cell < small_cells().size(); cell += 13)
    for (std::size_t i = 0; i < 6; ++i)
      CHECK(from_prior.channel(2).row(cell)[i] ==
            doctest::Approx(double{from_materials.channel(2).row(cell)[i]}).epsilon(0.01));
}

TEST_CASE("materials that cannot be used are refused by name") {
  auto broken = synthetic_materials(small_cells(), 3);
  broken.values(5, 7) = std::nanf("");
  CHECK_THROWS_WITH_AS((measured{broken, gonio::log{}}), doctest::Contains("'material-2' is not finite at cell 5"),
                       gonio::error);
  const auto reference = gonio::log_relative::to_median_of(synthetic_materials(small_cells(), 3));
  broken.values(5, 7) = -std::numeric_limits<float>::infinity();  // the metric would count it as zero
  CHECK_THROWS_WITH_AS((measured{broken, reference}), doctest::Contains("'material-2' is not finite at cell 5"),
                       gonio::error);
  CHECK_THROWS_WITH_AS((measured{synthetic_materials(small_cells(), 3), overflowing_metric{}}),
                       doctest::Contains("'material-0' is not finite at cell 0"), gonio::error);
  CHECK_THROWS_AS((measured{gonio::material_set{small_cells(), {}, {}}, gonio::log{}}), gonio::error);
  auto short_set = synthetic_materials(small_cells(), 3);
  short_set.names.pop_back();
  CHECK_THROWS_AS((measured{short_set, gonio::log{}}), gonio::error);
}
