#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/basis/discrepancy.hpp>
#include <gonio/basis/joined.hpp>
#include <gonio/estimate/fitted_brdf.hpp>

#include <vector>

namespace {

const gonio::log_relative_pca& components() {
  static const auto learned = learn(synthetic_materials(small_cells(), 6), 5);
  return learned;
}

gonio::discrepancy<gonio::log_relative> smooth(const gonio::valid_cells& cells) {
  const std::vector<gonio::half_difference> centres{{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, {0.2, 0.9, 2.0}};
  return {cells, components().metric(), gonio::discrepancy_functions(centres, 0.5)};
}

}  // namespace

TEST_CASE("rows of a joined basis are those of its two, one after the other") {
  const gonio::joined both{components(), smooth(small_cells())};
  static_assert(gonio::basis<decltype(both)>);
  static_assert(gonio::combining_basis<std::remove_const_t<decltype(both)>>);
  REQUIRE(both.size() == 8);
  const auto at = gonio::locate(small_cells(), {0.33, 0.44, 0.55});
  const Eigen::RowVectorXd row = gonio::row_at(both, at);
  CHECK((row.head(5) - gonio::row_at(both.first(), at)).norm() == 0.0);
  CHECK((row.tail(3) - gonio::row_at(both.second(), at)).norm() == 0.0);
  CHECK(both.offset(17) == components().offset(17));
}

TEST_CASE("a fit by a joined basis is tabulated as it is looked up") {
  const gonio::joined both{components(), smooth(small_cells())};
  const gonio::fitted_brdf fit(both, Eigen::MatrixXd(0.3 * Eigen::MatrixXd::Random(8, 3)));
  const gonio::brdf_table table = fit.tabulate(small_cells()), slow = fit.tabulate_cells(small_cells());
  double largest = 0.0;
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell)
    largest = std::max(largest, ((table.at(cell) - slow.at(cell)).abs() / (slow.at(cell) + 1e-3)).maxCoeff());
  CHECK(largest < 1e-4);
}

TEST_CASE("bases over different cells are not joined") {
  scratch::check_refused(
      [] {
        return gonio::joined{components(), smooth(gonio::valid_cells(gonio::grid({9, 7, 9})))};
      },
      {"the same cells"});
}
