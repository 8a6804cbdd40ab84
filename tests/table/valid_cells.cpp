#include "../golden.hpp"
#include "../json.hpp"
#include <gonio/table/valid_cells.hpp>

#include <doctest/doctest.h>
#include <zlib.h>

using gonio::valid_cells;

TEST_CASE("the valid cells of MERL's grid are the reference's") {
  const auto golden = golden_json("valid_mask.json");
  const valid_cells cells;
  CHECK(cells.size() == golden["nvalid"].get<std::size_t>());
  std::vector<unsigned char> mask(cells.grid().size());
  std::vector<int> per_theta_h(90), per_theta_d(90);
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    mask[cells.linear(cell)] = 1;
    const auto index = cells.grid().cell(cells.linear(cell));
    ++per_theta_h[index.theta_h];
    ++per_theta_d[index.theta_d];
  }
  CHECK(per_theta_h == golden["per_theta_h"].get<std::vector<int>>());
  CHECK(per_theta_d == golden["per_theta_d"].get<std::vector<int>>());
  CHECK(crc32(0, mask.data(), static_cast<unsigned>(mask.size())) == golden["crc32"].get<unsigned long>());
}

TEST_CASE("the linear index of a row's first valid cell") {
  const valid_cells cells(gonio::grid({20, 15, 24}));
  for (Eigen::Index row = 0; row < 20 * 15; ++row) {
    const Eigen::Index first = cells.row_begin(row);
    if (first < cells.row_begin(row + 1)) CHECK(cells.row_linear(row) == cells.linear(first));
  }
}

TEST_CASE("lower corners, and the stricter rule of one database") {
  const gonio::grid corner({}, gonio::cell_anchor::lower_corner);
  // Two more cells are valid because rounding turns a cosine of zero into 1e-17.
  CHECK(valid_cells(corner).size() == 1'111'430);
  CHECK(valid_cells(corner, 0.0200023).size() == 1'089'356);
}

TEST_CASE("a valid cell represents itself, an invalid one is represented by a valid one at smaller theta_h") {
  const valid_cells cells(gonio::grid({20, 15, 24}));
  std::size_t invalid = 0;
  for (Eigen::Index linear = 0; linear < cells.grid().size(); ++linear) {
    const std::size_t stand_in = cells.linear(cells.representative(linear));
    if (cells.contains(linear)) {
      CHECK(stand_in == linear);
      continue;
    }
    ++invalid;
    const auto missing = cells.grid().cell(linear), found = cells.grid().cell(stand_in);
    CHECK(found.theta_h < missing.theta_h);
    CHECK(found.theta_d == missing.theta_d);
    CHECK(found.phi_d == missing.phi_d);
  }
  CHECK(invalid > 0);
}

TEST_CASE("equality is of cells, not of objects") {
  const gonio::grid grid({5, 4, 6});
  CHECK(valid_cells(grid) == valid_cells(grid));
  CHECK_FALSE(valid_cells(grid) == valid_cells(grid, 0.3));
  CHECK_FALSE(valid_cells(grid) == valid_cells(gonio::grid({5, 4, 6}, gonio::cell_anchor::lower_corner)));
}

TEST_CASE("a threshold that leaves no cell is refused") {
  CHECK_THROWS_AS(valid_cells(gonio::grid({2, 2, 2}), 0.9999), gonio::error);
}
