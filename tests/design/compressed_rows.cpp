#include "synthetic_candidates.hpp"
#include <gonio/design/compressed_rows.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

namespace {

/// Rows of a few directions with small variations, like those of one image.
gonio::design::component_rows related_rows(Eigen::Index n, Eigen::Index k, unsigned seed) {
  std::srand(seed);
  const Eigen::MatrixXd rows =
      Eigen::MatrixXd::Random(n, 3) * Eigen::MatrixXd::Random(3, k) + 1e-6 * Eigen::MatrixXd::Random(n, k);
  return {rows, Eigen::VectorXd::Ones(n)};
}

void check_equivalent(const gonio::design::component_rows& rows, const gonio::design::component_rows& few,
                      double tolerance) {
  const double scale = rows.components.squaredNorm();
  CHECK((few.components.transpose() * few.components - rows.components.transpose() * rows.components).norm() <
        tolerance * scale);
  CHECK((few.components.transpose() * few.noise - rows.components.transpose() * rows.noise).norm() < tolerance * scale);
}

}  // namespace

TEST_CASE("compressed rows have the same normal equations, tall and wide") {
  for (const auto& [n, k] : {std::pair{200, 20}, {20, 200}, {50, 50}}) {
    const auto rows = related_rows(n, k, 5);
    const auto few = gonio::design::compressed(rows, 1e-4);
    CHECK(few.components.rows() == 3);
    check_equivalent(rows, few, 1e-6);
    check_equivalent(rows, gonio::design::compressed(rows, 0.0), 1e-12);
  }
}

TEST_CASE("cells that are met several times count as often") {
  const std::vector<Eigen::Index> cells{3, 60, 60, 60, 200, 3};
  std::vector<gonio::half_difference> directions;
  Eigen::MatrixXd each(6, std::ssize(candidate_basis()));
  for (Eigen::Index i = 0; i < std::ssize(cells); ++i) {
    directions.push_back(small_cells().angles(cells[i]));
    each.row(i) = candidate_basis().components().row(cells[i]).cast<double>();
  }
  const auto rows = gonio::design::rows_at(candidate_basis(), directions);
  CHECK(rows.components.rows() == 3);
  check_equivalent({each, Eigen::VectorXd::Ones(6)}, rows, 1e-12);
}
