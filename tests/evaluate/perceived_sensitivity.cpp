#include "../synthetic_materials.hpp"
#include <gonio/evaluate/perceived_sensitivity.hpp>
#include <gonio/render/lighting.hpp>
#include <gonio/render/sphere.hpp>

#include <doctest/doctest.h>

#include <numbers>

TEST_CASE("a small change of a channel moves CIELAB as the slopes say") {
  const gonio::perceived_sensitivity perceived(small_cells(), 9);
  const Eigen::Index cells = small_cells().size();
  const Eigen::MatrixXd grey = Eigen::MatrixXd::Constant(cells, 3, 0.1);
  const auto seen = perceived(grey, grey);  // the derivative of a logarithm's inverse
  CHECK(seen.weights.sum() == doctest::Approx(1.0));

  // All mapped values of green change by 0.01. The points under lights come last.
  const gonio::render::sphere_operator sphere(small_cells(), gonio::render::two_lights(), 9);
  gonio::brdf_table before(small_cells()), after(small_cells());
  for (Eigen::Index cell = 0; cell < cells; ++cell) {
    before.set(cell, gonio::rgb::Constant(0.1));
    after.set(cell, gonio::rgb(0.1, 0.1 * std::exp(0.01), 0.1));
  }
  const auto a = sphere.apply(before), b = sphere.apply(after);
  const Eigen::Index points = a.rows();
  REQUIRE(seen.weights.size() == 2 * points);
  for (Eigen::Index point = 0; point < points; point += 7) {
    const double moved =
        (gonio::to_lab(b.row(point).transpose()) - gonio::to_lab(a.row(point).transpose())).matrix().norm();
    CHECK(0.01 * seen.slopes.row(3 * (points + point) + 1).sum() == doctest::Approx(moved).epsilon(0.03));
  }
}

TEST_CASE("what is beyond white is not seen, and sizes must match") {
  const gonio::perceived_sensitivity perceived(small_cells(), 5);
  const Eigen::MatrixXd bright = Eigen::MatrixXd::Constant(small_cells().size(), 3, 1e6);
  CHECK(perceived(bright, bright).slopes.topRows(3).cwiseAbs().maxCoeff() == 0.0);
  const Eigen::MatrixXd few = Eigen::MatrixXd::Constant(3, 3, 1.0);
  CHECK_THROWS_WITH_AS(static_cast<void>(perceived(few, few)),
                       doctest::Contains("needs a row of three channels for each"), gonio::error);
}
