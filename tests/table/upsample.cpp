#include <gonio/table/upsample.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>

using gonio::valid_cells;

TEST_CASE("upsampling is interpolation at each cell, and visits each cell once") {
  const valid_cells from(gonio::grid({9, 7, 10}));
  gonio::cell_fields<2> fields(2, std::ssize(from));
  for (Eigen::Index cell = 0; cell < std::ssize(from); ++cell) {
    const auto angles = from.angles(cell);
    fields.col(cell) << static_cast<float>(std::cos(angles.theta_h + angles.theta_d)),
        static_cast<float>(std::cos(2 * angles.phi_d));
  }
  for (const auto& to : {from, valid_cells(gonio::grid({9, 21, 50})), valid_cells(gonio::grid({20, 5, 7})),
                         valid_cells(gonio::grid({11, 8, 12}, gonio::cell_anchor::lower_corner), 0.02)}) {
    std::vector<std::atomic<int>> visits(to.size());
    gonio::upsample<2>(
        from, fields, to,
        [&](const gonio::cell_row& row, const auto& values) {
          for (Eigen::Index i = 0; i < row.count; ++i) {
            const std::size_t cell = row.first + i;
            ++visits[cell];
            const auto at = gonio::locate(from, to.angles(cell));
            CHECK(row.theta_h == doctest::Approx(at.angles.theta_h));
            CHECK(to.grid().phi_d(static_cast<int>(row.first_phi_d + i)) == doctest::Approx(at.angles.phi_d));
            for (Eigen::Index f = 0; f < 2; ++f) {
              const auto value = [&](std::size_t c) { return double{fields(f, c)}; };
              CHECK(values(f, i) == doctest::Approx(gonio::interpolate(at, value, 0.0)).epsilon(1e-6));
            }
          }
        },
        {1});
    for (const auto& count : visits) CHECK(count == 1);
  }
}
