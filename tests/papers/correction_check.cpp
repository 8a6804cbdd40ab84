#include "papers/noell2014/correction_check.hpp"

#include "../synthetic_materials.hpp"
#include <gonio/metric/log.hpp>
#include <gonio/solve/least_squares.hpp>

#include <Eigen/QR>
#include <doctest/doctest.h>

using papers::deviations_from_others;

namespace {

gonio::correction corrections_of(const gonio::material_set& set, const gonio::correction_rule& rule = {}) {
  return gonio::correction{gonio::measured{set, gonio::log{}}, rule};
}

}  // namespace

TEST_CASE("deviations are those of a combination computed cell by cell") {
  const auto functions = corrections_of(synthetic_materials(small_cells(), 6));
  const auto found = deviations_from_others(functions, gonio::least_squares{});
  REQUIRE(found.size() == 6);
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::MatrixXd values = functions.channel(c).values().cast<double>();
    Eigen::MatrixXd others(values.rows(), 6);  // without the third, and with the constant function
    others << values.leftCols(2), values.rightCols(4);
    const Eigen::VectorXd weights = others.colPivHouseholderQr().solve(values.col(2));
    sum += (values.col(2) - others * weights).cwiseAbs().sum();
  }
  CHECK(found[2] == doctest::Approx(sum / (3.0 * static_cast<double>(small_cells().size()))).epsilon(1e-4));
}

TEST_CASE("non-negative combinations deviate at least as much in the square, and here on average") {
  const auto functions = corrections_of(synthetic_materials(small_cells(), 12));
  const auto free = deviations_from_others(functions, gonio::least_squares{});
  const auto bounded = deviations_from_others(functions, gonio::nnls{});
  for (std::size_t i = 0; i < 12; ++i) CHECK(bounded[i] > 0.5 * free[i]);
  CHECK(std::accumulate(bounded.begin(), bounded.end(), 0.0) > std::accumulate(free.begin(), free.end(), 0.0));
  CHECK(bounded == deviations_from_others(functions, gonio::nnls{}, {3}));
}

TEST_CASE("a material that is there twice is its twin's combination, and one that is left out is not asked for") {
  auto set = synthetic_materials(small_cells(), 6);
  set.names.push_back("twin");
  gonio::cell_matrix values(set.values.rows(), 21);
  values << set.values, set.values.middleCols(3, 3);
  set.values = values;
  const auto functions = corrections_of(set, gonio::correction_rule::as_printed());
  const auto found = deviations_from_others(functions, gonio::nnls{});
  REQUIRE(found.size() == 7);
  // Both are explained by each other, so both corrections are 1.
  CHECK(found[6] == doctest::Approx(found[1]).epsilon(1e-3));
  CHECK(found[6] < 1e-4);
  const auto fewer = deviations_from_others(functions.without({"twin"}), gonio::nnls{});
  REQUIRE(fewer.size() == 6);
  CHECK(fewer[1] > 10.0 * found[1]);
}
