#include <gonio/core/error.hpp>
#include <gonio/shape/assignment.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <iostream>  // rapidcheck.h does not include what it uses
#include <limits>
#include <numeric>
#include <random>
#include <set>

using gonio::shape::optimal_assignment;

namespace {

/// Returns costs with 50 different values, so that some are equal.
Eigen::MatrixXd any_costs(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd costs(rows, columns);
  for (double& cost : costs.reshaped()) cost = 0.1 * *rc::gen::inRange(-25, 25);
  return costs;
}

double assigned_cost(const Eigen::MatrixXd& costs, const std::vector<Eigen::Index>& columns) {
  double sum = 0.0;
  for (std::size_t row = 0; row < columns.size(); ++row)
    if (columns[row] >= 0) sum += costs(row, columns[row]);
  return sum;
}

/// Returns the least cost over all assignments of the rows, which must not outnumber the columns.
double least_cost_of_all(const Eigen::MatrixXd& costs) {
  std::vector<Eigen::Index> columns(costs.cols());
  std::iota(columns.begin(), columns.end(), Eigen::Index{0});
  double least = std::numeric_limits<double>::infinity();
  do {
    double sum = 0.0;
    for (Eigen::Index row = 0; row < costs.rows(); ++row) sum += costs(row, columns[row]);
    least = std::min(least, sum);
  } while (std::ranges::next_permutation(columns).found);
  return least;
}

/// Returns the number of rows with a column; -1 if a column occurs twice.
std::ptrdiff_t pairs_of(const std::vector<Eigen::Index>& columns) {
  std::set<Eigen::Index> distinct(columns.begin(), columns.end());
  distinct.erase(-1);
  const auto assigned = std::ranges::count_if(columns, [](Eigen::Index column) { return column >= 0; });
  return assigned == std::ssize(distinct) ? assigned : -1;
}

}  // namespace

TEST_CASE("no assignment of all is cheaper") {
  CHECK(rc::check([] {
    const Eigen::Index rows = *rc::gen::inRange(1, 8), columns = *rc::gen::inRange(1, 8);
    const Eigen::MatrixXd costs = any_costs(rows, columns);
    const auto found = optimal_assignment(costs);
    RC_ASSERT(found.size() == rows);
    RC_ASSERT(pairs_of(found) == std::min(rows, columns));
    const double least = rows <= columns ? least_cost_of_all(costs) : least_cost_of_all(costs.transpose());
    RC_ASSERT(std::abs(assigned_cost(costs, found) - least) < 1e-9);
  }));
}

TEST_CASE("many rows find their own columns") {
  // The expected pairs are optimal: each costs the price of its row (or column), and all other costs are higher.
  for (const auto& [rows, columns] : {std::pair(200, 200), std::pair(150, 220), std::pair(220, 150)}) {
    std::mt19937_64 generator(static_cast<std::uint64_t>(rows));
    const auto number = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
    std::vector<Eigen::Index> expected(std::max(rows, columns));
    std::iota(expected.begin(), expected.end(), Eigen::Index{0});
    for (std::size_t i = expected.size() - 1; i > 0; --i) std::swap(expected[i], expected[generator() % (i + 1)]);
    const bool wide = rows <= columns;
    Eigen::VectorXd prices(wide ? rows : columns);
    for (double& price : prices) price = 100.0 * number();
    Eigen::MatrixXd costs(rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i)
      for (Eigen::Index j = 0; j < columns; ++j) {
        const bool own = wide ? expected[i] == j : expected[j] == i;
        costs(i, j) = prices[wide ? i : j] + (own ? 0.0 : 1e-6 + number());
      }
    const auto found = optimal_assignment(costs);
    CHECK(pairs_of(found) == std::min(rows, columns));
    CHECK(assigned_cost(costs, found) == doctest::Approx(prices.sum()).epsilon(1e-12));
    for (Eigen::Index i = 0; wide && i < rows; ++i) CHECK(found[i] == expected[i]);
  }
}

TEST_CASE("the unit and the zero of costs do not matter") {
  CHECK(rc::check([] {
    const Eigen::MatrixXd costs = any_costs(6, 6);
    const double factor = *rc::gen::element(1e-200, 1e-3, 1.0, 1e30, 1e306), least = least_cost_of_all(costs);
    RC_ASSERT(std::abs(assigned_cost(costs, optimal_assignment(factor * costs)) - least) < 1e-9);
    const Eigen::MatrixXd shifted = costs.array() + 1000.0;
    RC_ASSERT(std::abs(assigned_cost(costs, optimal_assignment(shifted)) - least) < 1e-6);
  }));
  // The difference of these costs is not finite.
  const double huge = std::numeric_limits<double>::max();
  CHECK(optimal_assignment((Eigen::Matrix2d() << huge, -huge, -huge, huge).finished()) ==
        std::vector<Eigen::Index>{1, 0});
}

TEST_CASE("costs that do not differ, or are not there") {
  CHECK(pairs_of(optimal_assignment(Eigen::MatrixXd::Constant(5, 5, 3.0))) == 5);
  CHECK(pairs_of(optimal_assignment(Eigen::MatrixXd::Constant(5, 3, -3.0))) == 3);
  CHECK(optimal_assignment(Eigen::MatrixXd(0, 4)).empty());
  CHECK(optimal_assignment(Eigen::MatrixXd(2, 0)) == std::vector<Eigen::Index>{-1, -1});
}

TEST_CASE("costs that are not finite are refused") {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    Eigen::MatrixXd costs = Eigen::MatrixXd::Ones(3, 4);
    costs(2, 1) = bad;
    CHECK_THROWS_WITH_AS((void)optimal_assignment(costs), "the cost of assigning row 2 to column 1 is not finite",
                         gonio::error);
  }
}
