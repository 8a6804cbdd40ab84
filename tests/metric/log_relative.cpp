#include "../golden.hpp"
#include <gonio/metric/log_relative.hpp>
#include <gonio/table/material_set.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::log_relative;
using gonio::valid_cells;

static_assert(!gonio::error_metric<int>);

TEST_CASE("the map and its inverse agree with the reference") {
  const auto golden = golden_csv("mapping.csv");
  for (std::size_t i = 0; i < golden.at("rho").size(); ++i) {
    CAPTURE(i);
    const double rho = golden.at("rho")[i], reference = golden.at("rho_ref")[i], weight = golden.at("cosweight")[i];
    const double x = log_relative::forward(rho, reference, weight);
    CHECK(x == doctest::Approx(golden.at("x")[i]).epsilon(1e-12).scale(1));
    CHECK(log_relative::inverse(golden.at("x")[i], reference, weight) ==
          doctest::Approx(golden.at("rho_back")[i]).epsilon(1e-10).scale(1e-6));
  }
}

TEST_CASE("the metric is increasing, its inverse undoes it, and a location of a cell is the cell") {
  const valid_cells cells(gonio::grid({12, 10, 14}));
  std::vector<float> reference(cells.size());
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) reference[cell] = 0.01f * static_cast<float>(cell % 97);
  const log_relative metric(cells, reference);
  CHECK(rc::check([&] {
    const std::size_t cell = *rc::gen::inRange<std::size_t>(0, cells.size());
    const double rho = std::exp(*rc::gen::inRange(-1000, 800) * 0.01), more = rho * 1.001;
    const auto at = gonio::locate_cell(cells, cell);
    RC_ASSERT(metric.forward(rho, cell) == metric.forward(rho, at));
    RC_ASSERT(metric.forward(more, cell) > metric.forward(rho, cell));
    const double back = metric.inverse(metric.forward(rho, at), cell);
    RC_ASSERT(std::abs(back - rho) < 1e-9 * (rho + 1.0));
  }));
}

TEST_CASE("reflectance is weighted by the cosines' product (Nielsen 2015), or by the larger one (Xu 2016)") {
  const valid_cells cells(gonio::grid({12, 10, 14}));
  const log_relative product(cells, std::vector<float>(cells.size(), 0.4f)),
      larger = product.weighted_by(gonio::cosine_weighting::larger);
  CHECK(product.weighting() == gonio::cosine_weighting::product);
  CHECK(product.cosine_weight({0.5, 0.2}) == doctest::Approx(0.1));
  CHECK(larger.cosine_weight({0.5, 0.2}) == 0.5);
  CHECK(larger.cosine_weight({0.5, 0.7}) == 0.7);
  CHECK(larger.cosine_weight({1e-5, 1e-6}) == log_relative::epsilon);
  CHECK(larger.on(valid_cells(gonio::grid({4, 4, 4}))).weighting() == gonio::cosine_weighting::larger);
  for (Eigen::Index cell = 0; cell < cells.size(); cell += 7) {
    const auto at = gonio::locate_cell(cells, cell);
    const double c = std::max(at.cosine.i, at.cosine.o), rho = 0.07;
    const double expected = std::log((rho * c + 0.001) / (double{0.4f} * c + 0.001));
    REQUIRE(larger.forward(rho, cell) == doctest::Approx(expected).epsilon(1e-12));
    REQUIRE(larger.forward(rho, at) == doctest::Approx(expected).epsilon(1e-12));
    REQUIRE(larger.inverse(expected, cell) == doctest::Approx(rho).epsilon(1e-12));
  }
}

TEST_CASE("negative reflectance counts as zero") {
  const valid_cells cells(gonio::grid({4, 4, 4}));
  const log_relative metric(cells, std::vector<float>(cells.size(), 0.5f));
  CHECK(metric.forward(-3.0, std::size_t{2}) == metric.forward(0.0, std::size_t{2}));
  CHECK(metric.inverse(-100.0, std::size_t{2}) < 0.0);
}

TEST_CASE("between cells the reference lies between its neighbours") {
  const valid_cells cells(gonio::grid({12, 10, 14}));
  std::vector<float> reference(cells.size());
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell)
    reference[cell] = static_cast<float>(std::exp(-3.0 * cells.angles(cell).theta_h));
  const log_relative metric(cells, reference);
  const double theta_h = 0.5 * (cells.grid().theta_h(3) + cells.grid().theta_h(4));
  const double between = metric.reference(gonio::locate(cells, {theta_h, 0.3, 0.5}));
  CHECK(between < std::exp(-3.0 * cells.grid().theta_h(3)));
  CHECK(between > std::exp(-3.0 * cells.grid().theta_h(4)));
}

TEST_CASE("the reference is the median of all columns, odd and even") {
  const valid_cells cells(gonio::grid({2, 2, 2}));
  gonio::material_set set{cells, {"a"}, gonio::cell_matrix(cells.size(), 3)};
  set.values.rowwise() = Eigen::RowVector3f(5, 1, 3);
  CHECK(log_relative::to_median_of(set).reference()[1] == 3.0f);
  gonio::material_set even{cells, {"a", "b"}, gonio::cell_matrix(cells.size(), 6)};
  even.values.rowwise() = Eigen::Matrix<float, 1, 6>(9, 1, 3, 4, 8, 0);
  CHECK(log_relative::to_median_of(even).reference()[1] == 3.5f);
}

TEST_CASE("a reference that does not fit is refused") {
  const valid_cells cells(gonio::grid({2, 2, 2}));
  CHECK_THROWS_WITH_AS(log_relative(cells, std::vector<float>(3)), doctest::Contains("3 values"), gonio::error);
  CHECK_THROWS_AS(log_relative(cells, std::vector<float>(cells.size(), -1.0f)), gonio::error);
  CHECK_THROWS_AS(log_relative(cells, std::vector<float>(cells.size(), std::nanf(""))), gonio::error);
}
