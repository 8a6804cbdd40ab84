#include "../synthetic_materials.hpp"
#include <gonio/core/error.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/texels/texel_metric.hpp>

#include <doctest/doctest.h>

#include <cmath>

TEST_CASE("metric of texels: distances are those of the mapped values over all cells and channels") {
  const auto prior = learn(synthetic_materials(gonio::valid_cells(gonio::grid({12, 9, 10})), 8), 5);
  Eigen::MatrixXf functions(5, 3);
  functions << 0.5f, 0.25f, 0.1f, -1.0f, 0.125f, 0.3f, 0.0f, 2.0f, 1.0f, 0.75f, 0.0f, 0.2f, -0.5f, 1.0f, 0.4f;
  const Eigen::MatrixXf metric = gonio::texel_metric(prior, functions);
  REQUIRE(metric.rows() == 3);
  // Weights of typical size in the prior: not tiny, and not so large that reflectance is clamped.
  Eigen::MatrixXf one(3, 3), other(3, 3);
  one << 0.02f, -0.05f, 0.1f, 0.04f, 0.03f, -0.06f, 0.01f, 0.02f, 0.03f;
  other << -0.02f, 0.05f, 0.02f, 0.0f, 0.06f, 0.02f, 0.03f, -0.02f, 0.01f;
  double squares = 0.0;
  for (Eigen::Index cell = 0; cell < prior.cells().size(); ++cell) {
    const Eigen::RowVectorXd row =
        Eigen::Map<const Eigen::RowVectorXf>(prior.row(cell).data(), 5).cast<double>() * functions.cast<double>();
    squares += (row * (one - other).cast<double>()).squaredNorm();
  }
  const double expected = std::sqrt(squares / (3.0 * static_cast<double>(prior.cells().size())));
  CHECK((metric * (one - other)).norm() == doctest::Approx(expected).epsilon(1e-3));
  // Ordered by falling variance.
  CHECK(metric.row(0).norm() >= metric.row(1).norm());
  CHECK_THROWS_WITH_AS((void)gonio::texel_metric(prior, functions.topRows(4)),
                       doctest::Contains("functions of 4 components, expected 5"), gonio::error);
}
