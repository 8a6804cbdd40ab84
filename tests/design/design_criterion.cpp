#include "../dense_reference.hpp"
#include "synthetic_candidates.hpp"
#include <gonio/design/criterion_of_plan.hpp>
#include <gonio/design/search.hpp>
#include <gonio/solve/singular_values.hpp>

#include <doctest/doctest.h>

using gonio::design::a_optimality;
using gonio::design::condition_number;
using gonio::design::d_optimality;

namespace {

/// The smallest possible criterion.
struct first_entry {
  double operator()(const Eigen::MatrixXd& components) const { return components(0, 0); }
};
static_assert(gonio::design::design_criterion<first_entry>);

Eigen::MatrixXd random_rows(Eigen::Index n, Eigen::Index k) {
  std::srand(11);
  return Eigen::MatrixXd::Random(n, k);
}

/// The textbook covariance of the weights for noise of variance 1.
Eigen::MatrixXd covariance(const Eigen::MatrixXd& r, double eta) {
  return dense_reference::inverse(r.transpose() * r + eta * Eigen::MatrixXd::Identity(r.cols(), r.cols()));
}

}  // namespace

TEST_CASE("the condition number is the ratio of the singular values; of one row, its length counts") {
  for (const auto& [n, k] : {std::pair{2, 30}, {7, 30}, {30, 7}, {8, 8}}) {
    const Eigen::MatrixXd rows = random_rows(n, k);
    const Eigen::VectorXd values = dense_reference::svd(rows).values;
    CHECK(condition_number{}(rows) == doctest::Approx(values[0] / values[values.size() - 1]).epsilon(1e-9));
  }
  const Eigen::MatrixXd row = random_rows(1, 5);
  CHECK(condition_number{}(row) == doctest::Approx(1.0 / row.norm()));
  CHECK(condition_number{}(2.0 * row) < condition_number{}(row));
  Eigen::MatrixXd twice(2, 5);
  twice << row, row;
  CHECK(std::isinf(condition_number{}(twice)));
}

TEST_CASE("condition numbers are told up to rounding: neighbouring pixels make them far larger than 1e7") {
  const Eigen::MatrixXd u = dense_reference::orthonormal_columns(random_rows(40, 12)),
                        v = dense_reference::orthonormal_columns(random_rows(12, 12));
  for (const double condition : {1e3, 1e8, 1e11, 1e13}) {
    Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(12, 1.0, 2.0) / 2.0;
    values[0] = 1.0 / condition;
    CAPTURE(condition);
    // The relative accuracy of the smallest singular value.
    const double rounding = gonio::singular_value_rounding(12) * condition + 1e-12;
    const Eigen::MatrixXd tall = u * values.asDiagonal() * v.transpose();
    CHECK(condition_number{}(tall) == doctest::Approx(condition).epsilon(rounding));
    CHECK(condition_number{}(tall.transpose()) == doctest::Approx(condition).epsilon(rounding));
  }
}

TEST_CASE("A- and D-optimality are the trace and the volume of the weights' covariance") {
  const double eta = 0.7;
  const Eigen::VectorXd energies = Eigen::VectorXd::LinSpaced(9, 3.0, 0.5);
  for (const Eigen::Index n : {1, 4, 20}) {
    const Eigen::MatrixXd rows = random_rows(n, 9), after = covariance(rows, eta);
    const double trace = (energies.asDiagonal() * after).trace(), before = energies.sum() / eta;
    CHECK(a_optimality(energies, eta)(rows) == doctest::Approx(trace / before).epsilon(1e-10));
    CHECK(d_optimality(eta)(rows) ==
          doctest::Approx(0.5 * std::log(dense_reference::determinant(after) * std::pow(eta, 9))));
  }
}

TEST_CASE("more measurements are never worse, and their order does not matter") {
  const Eigen::MatrixXd rows = random_rows(6, 9), fewer = rows.topRows(5), turned = rows.colwise().reverse();
  const a_optimality a(Eigen::VectorXd::Ones(9), 0.5);
  const d_optimality d(0.5);
  CHECK(a(rows) < a(fewer));
  CHECK(d(rows) < d(fewer));
  CHECK(a(turned) == doctest::Approx(a(rows)).epsilon(1e-12));
  CHECK(d(turned) == doctest::Approx(d(rows)).epsilon(1e-12));
  CHECK(condition_number{}(turned) == doctest::Approx(condition_number{}(rows)).epsilon(1e-9));
}

TEST_CASE("any criterion guides a search") {
  const gonio::design::point_geometry points(small_cells());
  const gonio::design::criterion_of_plan condition{candidate_basis(), points, condition_number{}};
  const auto found = gonio::design::grow_and_descend(points, condition, 3, 50, 1);
  CHECK(found.value >= 1.0);
  CHECK(found.value <= gonio::design::swap_at_random(points, condition, 3, 50, 1).value);
}

TEST_CASE("what cannot be is refused") {
  CHECK_THROWS_WITH_AS(d_optimality(0.0), doctest::Contains("eta must be positive"), gonio::error);
  CHECK_THROWS_AS(a_optimality(Eigen::VectorXd::Ones(3), -1.0), gonio::error);
  CHECK_THROWS_WITH_AS(a_optimality(Eigen::VectorXd::Zero(3), 1.0), doctest::Contains("not all zero"), gonio::error);
}
