#include <gonio/estimate/out_of_gamut.hpp>

#include <doctest/doctest.h>

#include <vector>

TEST_CASE("colours become XYZ where more than one in ten has a negative channel") {
  gonio::located_samples ten{std::vector<gonio::location>(10), Eigen::MatrixXd::Constant(10, 3, 0.5),
                             Eigen::MatrixXd::Ones(10, 1)};
  ten.values(4, 0) = -0.1;
  CHECK(!gonio::out_of_gamut_as_xyz(ten));
  ten.values.row(5).setZero();  // black is in the gamut
  CHECK(!gonio::out_of_gamut_as_xyz(ten));
  ten.values.row(5).setConstant(0.5);
  ten.values(5, 0) = -0.1;
  const Eigen::MatrixXd xyz = gonio::out_of_gamut_as_xyz(ten).value().values;
  CHECK(xyz.minCoeff() > 0.0);
  CHECK(xyz(0, 0) == doctest::Approx(0.5));  // relative to white
  CHECK(xyz(0, 2) == doctest::Approx(0.5));
  CHECK(xyz(5, 1) == doctest::Approx(-0.1 * 0.2126 + 0.5 * (1.0 - 0.2126)).epsilon(1e-3));
  ten.weights = Eigen::MatrixXd::Ones(10, 3);
  CHECK(!gonio::out_of_gamut_as_xyz(ten));
}
