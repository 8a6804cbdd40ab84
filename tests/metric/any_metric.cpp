#include <gonio/metric/any_metric.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

using gonio::any_metric;

namespace {

const gonio::valid_cells& small_cells() {
  static const gonio::valid_cells cells(gonio::grid({6, 5, 7}));
  return cells;
}

gonio::log_relative relative_to_something() {
  std::vector<float> reference(small_cells().size());
  for (Eigen::Index cell = 0; cell < std::ssize(reference); ++cell)
    reference[cell] = 0.01f * static_cast<float>(cell % 13);
  return {small_cells(), reference};
}

/// Checks that any_metric agrees with the metric it holds: at cells, at locations, and for a row of cells.
template <gonio::row_metric Metric>
void check_held(const Metric& metric) {
  const any_metric chosen = metric;
  const gonio::valid_cells& cells = small_cells();
  CHECK(rc::check([&] {
    const double rho = std::exp(*rc::gen::inRange(-1000, 500) * 0.01) * *rc::gen::element(-1.0, 1.0);
    const std::size_t cell = *rc::gen::inRange<std::size_t>(0, cells.size());
    const auto at = gonio::locate_cell(cells, cell);
    RC_ASSERT(chosen.forward(rho, cell) == metric.forward(rho, cell));
    RC_ASSERT(chosen.forward(rho, at) == metric.forward(rho, at));
    const double y = metric.forward(rho, cell);
    RC_ASSERT(chosen.inverse(y, cell) == metric.inverse(y, cell));
    RC_ASSERT(chosen.inverse(y, at) == metric.inverse(y, at));
    RC_ASSERT(chosen.on(cells).forward(rho, cell) == metric.forward(rho, cell));
  }));

  // Mapped values of two neighbouring cells, and the additional fields that are interpolated with them.
  constexpr std::size_t count = 2, first = 3;
  std::array<double, 7> cosines{};
  for (std::size_t i = 0; i < cosines.size(); ++i) cosines[i] = std::cos(0.3 * static_cast<double>(i));
  gonio::cell_row row;
  row.first = first;
  row.count = count;
  row.first_phi_d = 2;
  row.sum = 0.7;
  row.difference = 0.1;
  row.cos_phi_d = cosines.data();
  gonio::cell_fields<3 + Metric::companions> own(3 + Metric::companions, count);
  gonio::cell_fields<3 + any_metric::companions> all(3 + any_metric::companions, count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Index column = i;
    for (Eigen::Index c = 0; c < 3; ++c)
      own(c, column) = all(c, column) = 0.4f * static_cast<float>(c) - 0.3f * static_cast<float>(i);
    const auto beside = chosen.companion(first + i);
    all(3, column) = beside[0];
    if constexpr (Metric::companions > 0) own(3, column) = metric.companion(first + i)[0];
  }
  if constexpr (Metric::mean == gonio::weighted_mean::geometric) gonio::exponentiate(own.data(), own.size());
  std::array<float, 3 * count> expected{}, found{};
  metric.inverse_row(row, own, expected);
  chosen.inverse_row(row, all, found);
  for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i] == doctest::Approx(expected[i]).epsilon(1e-6));
}

}  // namespace

TEST_CASE("a metric chosen at run time gives the same as the metric that it holds") {
  SUBCASE("lin") { check_held(gonio::lin{}); }
  SUBCASE("root") { check_held(gonio::root{}); }
  SUBCASE("another root") { check_held(gonio::root{3.0}); }
  SUBCASE("log") { check_held(gonio::log{}); }
  SUBCASE("log-relative") { check_held(relative_to_something()); }
  SUBCASE("log-relative, weighted by the larger cosine") {
    check_held(relative_to_something().weighted_by(gonio::cosine_weighting::larger));
  }
}

TEST_CASE("a metric chosen at run time is a metric, and another may replace it") {
  static_assert(gonio::row_metric<any_metric>);
  any_metric chosen = gonio::lin{};
  CHECK(chosen.forward(3.0, std::size_t{0}) == 3.0);
  chosen = gonio::root{};
  CHECK(chosen.forward(9.0, std::size_t{0}) == 3.0);
  CHECK(std::holds_alternative<gonio::root>(chosen.held()));
}
