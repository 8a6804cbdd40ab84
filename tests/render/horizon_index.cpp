#include <gonio/render/horizon_index.hpp>
#include <gonio/table/valid_cells.hpp>

#include <doctest/doctest.h>

TEST_CASE("horizon index: numbers and representatives are those of the valid cells, in a hundredth of the memory") {
  for (const gonio::grid& cells :
       {gonio::grid(), gonio::grid({45, 30, 60}), gonio::grid({13, 7, 31}), gonio::grid({4, 4, 4}),
        gonio::grid({45, 30, 60}, gonio::cell_anchor::lower_corner)}) {
    const gonio::valid_cells expected(cells);
    const gonio::render::horizon_index index(cells);
    CHECK(index.size() == expected.size());
    std::size_t other = 0;
    for (Eigen::Index linear = 0; linear < cells.size(); ++linear) {
      const auto [h, d, p] = cells.cell(linear);
      const Eigen::Index number = index(h, d, p);
      other += number == expected.representative(linear) ? 0u : 1u;
    }
    CHECK(other == 0u);
  }
  CHECK(gonio::render::horizon_index().memory() < 100'000u);
}
