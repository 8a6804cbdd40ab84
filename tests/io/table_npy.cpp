#include "scratch.hpp"
#include <gonio/io/table_npy.hpp>

using gonio::io::read_npy;

TEST_CASE("a table as an array: the values of its cells in the grid's order, and no hole below the horizon") {
  const scratch::folder folder;
  gonio::brdf_table table(gonio::valid_cells(gonio::grid({8, 5, 6})));
  for (std::size_t i = 0; i < table.values().size(); ++i) table.values()[i] = static_cast<float>(i);
  const auto path = folder / "t.npy";
  gonio::io::write_table_npy(path, table);
  const auto array = read_npy<float, 4>(path);
  REQUIRE(array.shape(0) == 8u);
  REQUIRE(array.shape(1) == 5u);
  REQUIRE(array.shape(2) == 6u);
  REQUIRE(array.shape(3) == 3u);
  const gonio::grid& cells = table.cells().grid();
  std::size_t other = 0, below = 0;
  for (Eigen::Index linear = 0; linear < cells.size(); ++linear) {
    const auto [h, d, p] = cells.cell(linear);
    const std::size_t cell = table.cells().representative(linear);
    below += table.cells().contains(linear) ? 0u : 1u;
    for (int channel = 0; channel < 3; ++channel)
      other += array(h, d, p, channel) == static_cast<float>(3 * cell + channel) ? 0u : 1u;
  }
  CHECK(other == 0u);
  CHECK(below > 0u);
}
