#include "../synthetic_materials.hpp"
#include <gonio/basis/expand_materials.hpp>
#include <gonio/basis/learn_streamed_pca.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/scratch_materials.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

namespace {

gonio::io::scratch_materials scratch_of(const gonio::material_set& set, std::uint64_t memory) {
  gonio::io::scratch_materials scratch(std::filesystem::temp_directory_path(), memory);
  for (Eigen::Index m = 0; m < std::ssize(set.names); ++m) scratch.append(set.names[m], set.table(m));
  return scratch;
}

}  // namespace

TEST_CASE("tables are read back from memory and from the scratch file") {
  const auto set = synthetic_materials(small_cells(), 7);
  const std::uint64_t table = 12 * small_cells().size();
  for (const std::uint64_t memory : {std::uint64_t{0}, table, 3 * table, 7 * table, 100 * table}) {
    CAPTURE(memory / table);
    auto scratch = scratch_of(set, memory);
    const gonio::material_rows rows = scratch.rows();
    CHECK(scratch.file_size() == (memory < 7 * table ? 7 * table : 0));
    CHECK(rows.cells == small_cells());
    CHECK(rows.names == set.names);
    gonio::cell_matrix all(set.values.rows(), set.values.cols());
    for (Eigen::Index begin = 0; begin < all.rows(); begin += 100) {
      const gonio::block range{begin, std::min<Eigen::Index>(all.rows(), begin + 100)};
      rows.read(range, all.middleRows(begin, range.size()));
    }
    CHECK(all == set.values);
  }
}

TEST_CASE("spectra are read back, a material's wavelengths in adjacent columns") {
  const std::vector<double> wavelengths{400.0, 500.0, 600.0, 700.0};
  const auto set = synthetic_materials(small_cells(), 8);
  const std::uint64_t table = 16 * small_cells().size();
  for (const std::uint64_t memory : {std::uint64_t{0}, 2 * table, 100 * table}) {
    gonio::io::scratch_materials scratch(std::filesystem::temp_directory_path(), memory);
    for (Eigen::Index m = 0; m < 6; ++m)
      scratch.append(std::to_string(m),
                     gonio::spectral_table(small_cells(), wavelengths, set.values.middleCols(4 * m, 4)));
    const gonio::material_rows rows = scratch.rows();
    CHECK(rows.wavelengths == wavelengths);
    CHECK(rows.columns() == 24);
    CHECK(scratch.file_size() == (memory < 6 * table ? 6 * table : 0));
    gonio::cell_matrix all(set.values.rows(), set.values.cols());
    rows.read({0, all.rows()}, all);
    CHECK(all == set.values);
  }
}

TEST_CASE("tables of other cells or channels, and a missing folder, are refused") {
  gonio::io::scratch_materials none(std::filesystem::temp_directory_path());
  CHECK_THROWS_AS(none.rows(), gonio::error);
  none.append("one", gonio::brdf_table(small_cells()));
  CHECK_THROWS_WITH_AS(none.append("other", gonio::brdf_table(gonio::valid_cells(gonio::grid({5, 5, 5})))),
                       doctest::Contains("'other' has other cells"), gonio::error);
  const gonio::cell_matrix two = gonio::cell_matrix::Ones(small_cells().size(), 2);
  CHECK_THROWS_WITH_AS(none.append("two channels", small_cells(), {}, two), doctest::Contains("two channels"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(none.append("spectra", gonio::spectral_table(small_cells(), {500.0, 600.0, 700.0})),
                       doctest::Contains("'spectra' has other wavelengths"), gonio::error);
  gonio::io::scratch_materials nowhere("/no/such/folder", 0);
  nowhere.append("one", gonio::brdf_table(small_cells()));
  CHECK_THROWS_WITH_AS(nowhere.append("other", gonio::brdf_table(small_cells())), doctest::Contains("/no/such/folder"),
                       gonio::error);
}

TEST_CASE("300 columns streamed from a scratch file give the prior that is learned in memory") {
  const auto prior = gonio::io::read_prior(std::string(GONIO_SOURCE_DIR) + "/examples/data/materials.prior");
  std::vector<Eigen::Index> hundred(100);
  std::iota(hundred.begin(), hundred.end(), Eigen::Index{0});
  const gonio::valid_cells coarse(gonio::grid({30, 10, 12}));
  const auto set = gonio::expand(gonio::thin(prior, coarse)).subset(hundred);
  REQUIRE(set.values.cols() == 300);
  auto scratch = scratch_of(set, 12 * 30 * set.cells.size());
  const auto streamed = gonio::learn_streamed_pca(scratch.rows(), {.components = 60});
  CHECK(scratch.file_size() == 4 * set.values.size());
  const auto known = learn(set, 60);
  const auto difference = [](const auto& a, const auto& b) {
    return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
  };
  CHECK(streamed.exact);
  CHECK(difference(streamed.prior.components(), known.components()) < 1e-5f);
  CHECK(difference(streamed.prior.coefficients(), known.coefficients()) < 1e-5f);
  CHECK(difference(streamed.prior.singular_values(), known.singular_values()) < 1e-9);
  CHECK(streamed.prior.mean() == known.mean());
  CHECK(std::ranges::equal(streamed.prior.metric().reference(), known.metric().reference()));
}
