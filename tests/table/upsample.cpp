#include <gonio/table/upsample.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <vector>

using gonio::valid_cells;
using gonio::weighted_mean;

namespace {

const valid_cells& coarse() {
  static const valid_cells cells(gonio::grid({9, 7, 10}));
  return cells;
}

std::vector<valid_cells> targets() {
  return {coarse(),
          valid_cells(gonio::grid({9, 21, 50})),
          valid_cells(gonio::grid({20, 5, 7})),
          valid_cells(gonio::grid({9, 9, 200})),
          valid_cells(gonio::grid({9, 11, 15})),
          valid_cells(gonio::grid({11, 28, 12}, gonio::cell_anchor::lower_corner), 0.02)};
}

/// Two smooth fields at a cell; the second has the range `size`.
std::array<float, 2> smooth_fields(Eigen::Index cell, double size) {
  const auto angles = coarse().angles(cell);
  return {static_cast<float>(std::cos(angles.theta_h + angles.theta_d)),
          static_cast<float>(size * std::cos(2 * angles.phi_d) * std::cos(4 * angles.theta_d))};
}

/// Compares `upsample` with interpolated fields or their exponentials at each cell of a target.
template <weighted_mean Mean>
void check_mean(const valid_cells& to, double size) {
  std::vector<std::atomic<int>> visits(to.size());
  const auto read = [&](Eigen::Index cell, float* out) { std::ranges::copy(smooth_fields(cell, size), out); };
  gonio::upsample<2, Mean>(
      coarse(), read, to,
      [&](const gonio::cell_row& row, const auto& values) {
        for (Eigen::Index i = 0; i < row.count; ++i) {
          const Eigen::Index cell = row.first + i;
          ++visits[cell];
          const auto at = gonio::locate(coarse(), to.angles(cell));
          CHECK(row.theta_h == doctest::Approx(at.angles.theta_h));
          CHECK(row.theta_d == doctest::Approx(at.angles.theta_d));
          CHECK(row.cosine(i).i == doctest::Approx(at.cosine.i));
          CHECK(to.grid().phi_d(static_cast<int>(row.first_phi_d + i)) == doctest::Approx(at.angles.phi_d));
          for (Eigen::Index f = 0; f < 2; ++f) {
            double expected = gonio::interpolate(
                at, [&](Eigen::Index c) { return double{smooth_fields(c, size)[f]}; }, 0.0);
            double error = 1e-6 * size;
            if (Mean == weighted_mean::geometric) {
              error = 4e-7 * (5.0 + std::abs(expected)) * std::exp(expected);
              expected = std::exp(expected);
            }
            CHECK(std::abs(values(f, i) - expected) <= error);
          }
        }
      },
      {1});
  for (const auto& count : visits) CHECK(count == 1);
}

}  // namespace

TEST_CASE("upsampling is interpolation at each cell, and visits each cell once") {
  for (const auto& to : targets()) check_mean<weighted_mean::arithmetic>(to, 3.0);
}

TEST_CASE("a geometric mean is the exponential of the interpolated field") {
  for (const auto& to : targets()) check_mean<weighted_mean::geometric>(to, 3.0);
}

TEST_CASE("a geometric mean of the largest and the smallest exponentials is as exact") {
  for (const auto& to : targets()) check_mean<weighted_mean::geometric>(to, 42.0);
}

TEST_CASE("a geometric mean that a progression cannot hold is computed for each value, up to infinity") {
  for (const double size : {50.0, 80.0, 200.0, 1e30}) {
    // Values alternate strongly from cell to cell, so that ratios of neighbours exceed the range of float.
    const auto field = [&](Eigen::Index cell) { return static_cast<float>(cell % 2 == 0 ? size : -size); };
    for (const auto& to : targets())
      gonio::upsample<1, weighted_mean::geometric>(
          coarse(), [&](Eigen::Index cell, float* out) { *out = field(cell); }, to,
          [&](const gonio::cell_row& row, const auto& values) {
            for (Eigen::Index i = 0; i < row.count; ++i) {
              const auto at = gonio::locate(coarse(), to.angles(row.first + i));
              const double logarithm = gonio::interpolate(
                  at, [&](Eigen::Index c) { return double{field(c)}; }, 0.0);
              const double found = std::log(double{values(0, i)}), rounding = 4e-7 * (5.0 + size);
              CHECK(!std::isnan(values(0, i)));
              if (std::abs(logarithm) < 87.0) CHECK(std::abs(found - logarithm) <= rounding);
              if (logarithm > 89.0 + rounding) CHECK(std::isinf(values(0, i)));
              if (logarithm < -104.0 - rounding) CHECK(values(0, i) < 1e-37f);
            }
          },
          {1});
  }
}

TEST_CASE("upsampling gives the same bytes for any number of threads") {
  const valid_cells to(gonio::grid({18, 20, 50}));
  const auto tabulated = [&](unsigned threads) {
    std::vector<float> all(2 * to.size());
    gonio::upsample<2, weighted_mean::geometric>(
        coarse(), [&](Eigen::Index cell, float* out) { std::ranges::copy(smooth_fields(cell, 3.0), out); }, to,
        [&](const gonio::cell_row& row, const auto& values) {
          std::copy_n(values.data(), values.size(), all.data() + 2 * row.first);
        },
        {threads});
    return all;
  };
  CHECK(tabulated(1) == tabulated(3));
}

TEST_CASE("runs of an axis cover its nodes in order, and are neither long nor of far nodes") {
  for (const int extent : {7, 13, 14, 28, 35, 400}) {
    const gonio::grid target({9, extent, extent});
    const gonio::detail::grid_runs runs(coarse().grid(), target);
    for (const auto& axis : {runs.theta_d, runs.phi_d}) {
      Eigen::Index next = 0;
      for (const auto& run : axis) {
        CHECK(run.first == next);
        CHECK(run.count <= gonio::detail::axis_run::longest);
        CHECK(run.step <= 0.5f);
        next += run.count;
      }
      CHECK(next == extent);
    }
  }
  // Along phi_d, five MERL nodes between two nodes of the prior; the first run is cut. Along theta_d, three; the first
  // two nodes are before the prior's first.
  const gonio::detail::grid_runs shipped(gonio::grid({90, 30, 36}), gonio::grid());
  CHECK(shipped.phi_d.size() == 37);
  CHECK(shipped.theta_d.size() == 31);
}
