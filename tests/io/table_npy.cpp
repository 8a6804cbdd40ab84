#include "scratch.hpp"
#include <gonio/io/materials/table_npy.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

using gonio::io::read_npy;

TEST_CASE("an array has a table's values in the grid's order, without holes below the horizon") {
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

TEST_CASE("an array is read back as the same table") {
  const scratch::folder folder;
  gonio::brdf_table table(gonio::valid_cells(gonio::grid({8, 5, 6})));
  for (std::size_t i = 0; i < table.values().size(); ++i) table.values()[i] = 0.25f * static_cast<float>(i);
  gonio::io::write_table_npy(folder / "t.npy", table);
  const auto read = [](const auto& path) {
    return gonio::io::read_table_npy(gonio::io::read_bytes(path), path.string());
  };
  const gonio::brdf_table again = read(folder / "t.npy");
  CHECK(again.cells() == table.cells());
  CHECK(std::ranges::equal(again.values(), table.values()));
  gonio::io::write_npy(folder / "flat.npy", xt::xtensor<float, 2>({4, 3}, 1.0f));
  scratch::check_refused([&] { return read(folder / "flat.npy"); }, {"flat.npy", "(4, 3)", "4 dimensions"});
  gonio::io::write_npy(folder / "two.npy", xt::xtensor<float, 4>({4, 3, 2, 2}, 1.0f));
  scratch::check_refused([&] { return read(folder / "two.npy"); }, {"two.npy", "(4, 3, 2, 2)", "phi_d, 3"});
  gonio::io::write_npy(folder / "none.npy", xt::xtensor<float, 4>({0, 3, 2, 3}, 1.0f));
  scratch::check_refused([&] { return read(folder / "none.npy"); }, {"none.npy", "at most 4096"});
  xt::xtensor<float, 4> wrong({4, 3, 2, 3}, 1.0f);
  wrong(0, 0, 0, 1) = std::numeric_limits<float>::infinity();
  gonio::io::write_npy(folder / "wrong.npy", wrong);
  scratch::check_refused([&] { return read(folder / "wrong.npy"); }, {"wrong.npy", "cell 0", "not finite"});
}

TEST_CASE("a table with values at lower corners is interpolated to the cells' centres") {
  const scratch::folder folder;
  const gonio::grid corner({16, 12, 24}, gonio::cell_anchor::lower_corner), centre(corner.extents());
  gonio::brdf_table table{gonio::valid_cells(corner)};
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
    table.set(cell, gonio::rgb::Constant(1.0 + table.cells().angles(cell).theta_d));
  gonio::io::write_table_npy(folder / "t.npy", table);
  const auto array = read_npy<float, 4>(folder / "t.npy");
  for (int d = 0; d + 1 < 12; ++d) CHECK(array(0, d, 0, 1) == doctest::Approx(1.0 + centre.theta_d(d)).epsilon(1e-6));
}

TEST_CASE("a table in half floats takes half the space and keeps 11 bits of each value") {
  const scratch::folder folder;
  gonio::brdf_table table(gonio::valid_cells(gonio::grid({8, 5, 6})));
  for (std::size_t i = 0; i < table.values().size(); ++i) table.values()[i] = 0.1f * static_cast<float>(i);
  gonio::io::write_table_npy_halves(folder / "h.npy", table);
  CHECK(std::filesystem::file_size(folder / "h.npy") == 128 + 2 * 3 * 8 * 5 * 6);
  const auto again = gonio::io::read_table_npy(gonio::io::read_bytes(folder / "h.npy"), "h.npy");
  for (std::size_t i = 0; i < table.values().size(); ++i)
    CHECK(std::abs(again.values()[i] - table.values()[i]) <= 0x1p-11f * table.values()[i]);
  table.values()[4] = 1e5f;
  scratch::check_refused([&] { return gonio::io::write_table_npy_halves(folder / "l.npy", table), 0; },
                         {"l.npy", "100000", "half floats"});
}
