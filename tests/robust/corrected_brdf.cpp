#include "../synthetic_materials.hpp"
#include <gonio/interpolate/completed_table.hpp>
#include <gonio/robust/corrected_brdf.hpp>

#include <doctest/doctest.h>

using gonio::brdf_table;
using gonio::corrected_brdf;
using gonio::correction_factor;

static_assert(gonio::tabulated_brdf<corrected_brdf<gonio::completed_table>>);
// The start of a correction may itself be a corrected estimate.
static_assert(gonio::tabulated_brdf<corrected_brdf<corrected_brdf<gonio::completed_table>>>);

namespace {

brdf_table factor_table(const gonio::valid_cells& over, float value) {
  return brdf_table(over, std::vector<float>(3 * over.size(), value));
}

corrected_brdf<gonio::completed_table> corrected_by(brdf_table factors, correction_factor rule) {
  return {gonio::completed_table(synthetic_materials(small_cells(), 1).table(0)), std::move(factors), rule, {}, {}};
}

}  // namespace

TEST_CASE("the estimate times the correction, with the rule's offset") {
  const auto estimate = synthetic_materials(small_cells(), 1).table(0);
  auto factors = factor_table(small_cells(), 1.0f);
  for (std::size_t i = 0; i < factors.values().size(); ++i)
    factors.values()[i] = 0.1f * static_cast<float>(i % 37);  // including zeros
  const auto printed = corrected_by(factors, correction_factor::as_printed()).tabulate(small_cells());
  const auto shifted = corrected_by(factors, {}).tabulate(small_cells());
  for (std::size_t i = 0; i < factors.values().size(); ++i) {
    const double sigma = double{factors.values()[i]}, rho = double{estimate.values()[i]};
    REQUIRE(double{printed.values()[i]} == doctest::Approx(sigma * rho).epsilon(1e-6));
    // Two roundings of a number of the size of the product.
    REQUIRE(std::abs(double{shifted.values()[i]} - std::max(sigma * (rho + 1e-3) - 1e-3, 0.0)) <=
            3e-7 * (1.0 + sigma) * (rho + 1e-3));
  }
}

TEST_CASE("evaluating and tabulating agree, on the correction's cells and on others") {
  auto factors = factor_table(gonio::valid_cells(gonio::grid({6, 5, 4})), 1.0f);
  for (std::size_t i = 0; i < factors.values().size(); ++i)
    factors.values()[i] = 0.5f + 0.1f * static_cast<float>(i % 11);
  const auto fit = corrected_by(factors, {});
  for (const auto& over : {small_cells(), factors.cells(), gonio::valid_cells(gonio::grid({9, 11, 6}))}) {
    const auto table = fit.tabulate(over, {1});
    CHECK(std::ranges::equal(table.values(), fit.tabulate(over, {3}).values()));
    for (Eigen::Index cell = 0; cell < over.size(); ++cell) {
      const auto [wi, wo] = to_directions(over.angles(cell));
      const gonio::rgb direct = fit(wi, wo);
      // The tables of estimate and factors are rounded to float before they are multiplied.
      REQUIRE((table.at(cell) - direct).abs().maxCoeff() <= 5e-7 * (1e-3 + direct.maxCoeff()));
    }
  }
}

TEST_CASE("a corrected BRDF is zero below the horizon, and where the correction is zero or negative") {
  const auto zero = corrected_by(factor_table(small_cells(), 0.0f), {});
  const auto negative = corrected_by(factor_table(small_cells(), -2.0f), correction_factor::as_printed());
  const auto one = corrected_by(factor_table(small_cells(), 1.0f), {});
  CHECK(std::ranges::all_of(zero.tabulate(small_cells()).values(), [](float value) { return value == 0.0f; }));
  CHECK(std::ranges::all_of(negative.tabulate(small_cells()).values(), [](float value) { return value == 0.0f; }));
  CHECK((zero({0, 0, 1}, {0, 0, 1}) == 0.0).all());
  CHECK((one({0, 0, 1}, {0, 0, 1}) > 0.0).all());
  CHECK((one({0, 0, 1}, {1, 0, 0}) == 0.0).all());
  CHECK((one({0, 0, -1}, {0, 0, 1}) == 0.0).all());
  CHECK((one({0, 0, 1}, {0, 0, -1}) == 0.0).all());
}

TEST_CASE("it has the parts that it was made of") {
  const auto factors = factor_table(small_cells(), 2.0f);
  const corrected_brdf fit{gonio::completed_table(synthetic_materials(small_cells(), 1).table(0)),
                           factors,
                           correction_factor{},
                           {Eigen::MatrixXd::Constant(2, 3, 7.0)},
                           {{0.1, 0.2, 0.3}}};
  CHECK(std::ranges::equal(fit.correction().values(), factors.values()));
  CHECK(std::ranges::equal(fit.initial().table().values(), synthetic_materials(small_cells(), 1).table(0).values()));
  REQUIRE(fit.weights().size() == 1);
  CHECK(fit.weights()[0](1, 2) == 7.0);
  REQUIRE(fit.history().size() == 1);
  CHECK(fit.history()[0].change == 0.2);
}
