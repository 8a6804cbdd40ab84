#include <gonio/solve/gram.hpp>

#include <doctest/doctest.h>

using float_rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

TEST_CASE("the Gram matrix of float columns is exact to double precision and independent of the threads") {
  for (const Eigen::Index rows : {1, 511, 512, 2000}) {
    const float_rows a = float_rows::Random(rows, 17);
    const Eigen::MatrixXd exact = a.cast<double>().transpose() * a.cast<double>();
    const Eigen::MatrixXd one = gonio::gram(a, {1}), three = gonio::gram(a, {3});
    CHECK(one.isApprox(exact, 1e-14));
    CHECK(one == three);
  }
}
