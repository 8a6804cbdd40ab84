#pragma once
/// Checks of every metric that is the same at all locations.

#include <gonio/metric/location_free.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <span>
#include <vector>

/// Checks that the metric increases, is odd, is inverted by its inverse, has the slope of its differences and is the
/// same at a cell and a location, and that a row of cells is mapped back like single cells.
template <gonio::row_metric Metric>
requires gonio::smooth_metric<Metric>
void check_location_free(const Metric& metric) {
  const gonio::valid_cells cells(gonio::grid({4, 4, 4}));
  CHECK(rc::check([&] {
    const double size = std::exp(*rc::gen::inRange(-1500, 900) * 0.01), rho = *rc::gen::element(-1.0, 1.0) * size;
    const std::size_t cell = *rc::gen::inRange<std::size_t>(0, cells.size());
    const auto at = gonio::locate_cell(cells, cell);
    const double y = metric.forward(rho, cell);
    RC_ASSERT(std::isfinite(y));
    RC_ASSERT(metric.forward(rho, at) == y);
    RC_ASSERT(metric.forward(-rho, cell) == -y);
    RC_ASSERT(metric.forward(rho + 1e-3 * size, cell) > y);
    RC_ASSERT(std::abs(metric.inverse(y, at) - rho) <= 1e-12 * size);
  }));
  CHECK(metric.forward(0.0, std::size_t{0}) == 0.0);
  CHECK(metric.inverse(0.0, std::size_t{0}) == 0.0);

  CHECK(std::isfinite(metric.slope(0.0)));
  for (const double rho : {-3.0, -0.2, 0.01, 0.4, 50.0}) {
    CAPTURE(rho);
    const double step = 1e-6 * std::abs(rho);
    const double difference = (metric.map(rho + step) - metric.map(rho - step)) / (2.0 * step);
    CHECK(metric.slope(rho) == doctest::Approx(difference).epsilon(1e-6));
  }

  gonio::cell_fields<3> mapped(3, 2);
  mapped << 0.5f, -0.5f, 2e-4f, 0.0f, 3.0f, 1.0f;
  std::array<float, 6> out{};
  gonio::cell_row row;
  row.count = 2;
  metric.inverse_row(row, mapped, out);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double one = std::max(metric.inverse(double{mapped.data()[i]}, std::size_t{0}), 0.0);
    CHECK(double{out[i]} == doctest::Approx(one).epsilon(1e-6));
  }

  // The bytes do not depend on a number's position: vectors of sixteen start at multiples of 64 bytes.
  std::vector<float> numbers(60);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = 0.07f * static_cast<float>(i);
  std::vector<float> all = numbers;
  metric.unmap_all(all);
  for (std::size_t first = 0; first < 17; ++first) {
    std::vector<float> some = numbers;
    metric.unmap_all(std::span(some).subspan(first, 20));
    for (std::size_t i = first; i < first + 20; ++i) CHECK(some[i] == all[i]);
  }
}
